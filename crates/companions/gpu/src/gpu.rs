//! The adapter, and the programs that run on it.

use super::buffers::with_driver_errors;
use std::fmt;
use thiserror::Error;

/// The reason why the GPU found no solution.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum GpuError {
    /// There is no suitable adapter.
    #[error(
        "no GPU can be used: {0}\n  hint: install a driver for Vulkan, Metal or Direct3D 12 (Linux without a graphics card: Mesa's software driver, in Debian mesa-vulkan-drivers), or solve on the CPU"
    )]
    NoAdapter(String),
    /// The request is invalid, with the reason.
    #[error("{0}")]
    Refused(String),
    /// The adapter has no buffers of this size.
    #[error(
        "a buffer of {needed} bytes is needed, but the GPU allows at most {most}\n  hint: use fewer cells, or solve on the CPU"
    )]
    TooLarge {
        /// Size of the largest necessary buffer, in bytes.
        needed: u64,
        /// Largest buffer of the adapter, in bytes.
        most: u64,
    },
    /// The GPU ran out of memory, or the device was lost. Contains the driver's message.
    #[error("the GPU failed: {0}\n  hint: use fewer cells, or solve on the CPU")]
    Failed(String),
    /// Values grew without bound, or became NaN.
    #[error("the relaxation diverged: after {sweeps} sweeps cell ({}, {}) has the value {value:e}", cell[0], cell[1])]
    Diverged {
        /// Number of sweeps after which the divergence was noticed.
        sweeps: u32,
        /// The first cell with such a value, as row and column.
        cell: [usize; 2],
        /// The value of that cell.
        value: f64,
    },
}

/// An opened GPU. Threads may share it.
pub struct Gpu {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    name: String,
    is_software: bool,
    pub(super) pipelines: Pipelines,
}

/// One pipeline per kernel.
pub(super) struct Pipelines {
    pub successive: wgpu::ComputePipeline,
    pub simultaneous: wgpu::ComputePipeline,
    pub finish: wgpu::ComputePipeline,
    pub smooth: wgpu::ComputePipeline,
    pub restrict: wgpu::ComputePipeline,
    pub prolong: wgpu::ComputePipeline,
}

impl Gpu {
    /// Opens the fastest adapter of the machine, or a software driver if there is no other. Takes some tenths of a
    /// second.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`] with a hint; [`GpuError::Failed`] if the driver refuses the kernels.
    pub fn open() -> Result<Self, GpuError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::VULKAN | wgpu::Backends::METAL | wgpu::Backends::DX12,
            // Use neither validation layers nor debuggers.
            flags: wgpu::InstanceFlags::empty(),
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let no_adapter = |reason: &dyn fmt::Display| GpuError::NoAdapter(reason.to_string());
        let wanted = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..wgpu::RequestAdapterOptions::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&wanted)).map_err(|e| no_adapter(&e))?;
        let info = adapter.get_info();
        let most = adapter.limits();
        let required_limits = wgpu::Limits {
            max_buffer_size: most.max_buffer_size,
            max_storage_buffer_binding_size: most.max_storage_buffer_binding_size,
            ..wgpu::Limits::downlevel_defaults()
        };
        // The kernels need more storage buffers than the guaranteed minimum.
        let required_limits = wgpu::Limits { max_storage_buffers_per_shader_stage: 6, ..required_limits };
        let wanted = wgpu::DeviceDescriptor { required_limits, ..wgpu::DeviceDescriptor::default() };
        let (device, queue) = pollster::block_on(adapter.request_device(&wanted)).map_err(|e| no_adapter(&e))?;
        let pipelines = with_driver_errors(&device, || Ok(Pipelines::new(&device)))?;
        let name = format!("{} ({})", info.name, info.backend);
        Ok(Self { device, queue, name, is_software: info.device_type == wgpu::DeviceType::Cpu, pipelines })
    }

    /// Returns the adapter's name and interface, such as `NVIDIA RTX A2000 (vulkan)`.
    pub fn adapter(&self) -> &str {
        &self.name
    }

    /// Returns true if the driver runs on the CPU.
    pub fn is_software(&self) -> bool {
        self.is_software
    }
}

impl fmt::Debug for Gpu {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Gpu").field("name", &self.name).finish_non_exhaustive()
    }
}

impl Pipelines {
    fn new(device: &wgpu::Device) -> Self {
        let rule = include_str!("kernels/rule.wgsl");
        let sweep = include_str!("kernels/sweep.wgsl");
        let successive = [rule, sweep, include_str!("kernels/successive.wgsl")].concat();
        let simultaneous = [rule, sweep, include_str!("kernels/simultaneous.wgsl")].concat();
        let finish = [rule, include_str!("kernels/finish.wgsl")].concat();
        let levels = include_str!("kernels/levels.wgsl");
        Self {
            successive: pipeline(device, &successive, "sweep"),
            simultaneous: pipeline(device, &simultaneous, "sweep"),
            finish: pipeline(device, &finish, "finish"),
            smooth: pipeline(device, levels, "relax"),
            restrict: pipeline(device, levels, "coarsen"),
            prolong: pipeline(device, levels, "prolong"),
        }
    }
}

fn pipeline(device: &wgpu::Device, text: &str, entry: &str) -> wgpu::ComputePipeline {
    let source = wgpu::ShaderSource::Wgsl(text.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(entry), source });
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry),
        layout: None,
        module: &module,
        entry_point: Some(entry),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    })
}
