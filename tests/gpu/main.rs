//! Fields relaxed on a GPU, compared with the CPU. All tests need a Vulkan driver, possibly in software: `.ci/gpu`.

mod command;
mod family;
