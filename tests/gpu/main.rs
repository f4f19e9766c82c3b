//! Fields relaxed on a GPU, against the same on the CPU. All need a driver of Vulkan, in software if need be: `.ci/gpu`.

mod command;
mod family;
