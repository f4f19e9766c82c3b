//! Fields relaxed on a GPU, against the same on the CPU. All need a driver of Vulkan, in software if need be: `.ci/gpu`.

#[path = "../common/random.rs"]
mod random;

mod command;
mod family;
