//! Transfers of numbers to and from the GPU.

use super::{Gpu, GpuError};
use wgpu::util::DeviceExt as _;

/// Threads of a block, along columns and rows.
pub(super) const THREADS_PER_BLOCK: [usize; 2] = [32, 8];

/// Returns the number of blocks that cover this many places, along columns and rows.
pub(super) fn blocks(columns: usize, rows: usize) -> [u32; 2] {
    [columns.div_ceil(THREADS_PER_BLOCK[0]) as u32, rows.div_ceil(THREADS_PER_BLOCK[1]) as u32]
}

impl Gpu {
    /// Creates a buffer that kernels can read and write, filled with these numbers. An empty buffer has room for one word.
    pub(super) fn storage<T: bytemuck::NoUninit>(&self, numbers: &[T]) -> Result<wgpu::Buffer, GpuError> {
        let bytes: &[u8] = if numbers.is_empty() { &[0; 16] } else { bytemuck::cast_slice(numbers) };
        let (needed, limits) = (bytes.len() as u64, self.device.limits());
        let most = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
        if needed > most {
            return Err(GpuError::TooLarge { needed, most });
        }
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        Ok(self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents: bytes, usage }))
    }

    /// Creates a buffer of a few numbers that all threads read.
    pub(super) fn uniform<T: bytemuck::NoUninit>(&self, numbers: &T) -> wgpu::Buffer {
        let contents = bytemuck::bytes_of(numbers);
        let usage = wgpu::BufferUsages::UNIFORM;
        self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
    }

    /// Returns a bind group, which connects buffers with the parameters of a kernel.
    pub(super) fn group(&self, pipeline: &wgpu::ComputePipeline, buffers: &[(u32, &wgpu::Buffer)]) -> wgpu::BindGroup {
        let entries = buffers
            .iter()
            .map(|&(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() });
        let entries: Vec<wgpu::BindGroupEntry> = entries.collect();
        let layout = &pipeline.get_bind_group_layout(0);
        self.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
    }

    pub(super) fn submit(&self, record: impl FnOnce(&mut wgpu::ComputePass)) {
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        record(&mut encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default()));
        self.queue.submit([encoder.finish()]);
    }

    /// Reads the first `bytes` of a buffer as numbers, after all submitted work.
    pub(super) fn read<T: bytemuck::Pod>(&self, buffer: &wgpu::Buffer, bytes: u64) -> Result<Vec<T>, GpuError> {
        let failed = |reason: &dyn std::fmt::Display| GpuError::Failed(reason.to_string());
        let copy = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: bytes,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, bytes);
        self.queue.submit([encoder.finish()]);
        // If mapping fails, reading the range reports the error with its reason.
        copy.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| failed(&error))?;
        let range = copy.slice(..).get_mapped_range().map_err(|error| failed(&error))?;
        Ok(bytemuck::pod_collect_to_vec(&range))
    }
}

/// Runs `work`, and returns errors of the driver on which wgpu would otherwise panic.
pub(super) fn with_driver_errors<T>(
    device: &wgpu::Device,
    work: impl FnOnce() -> Result<T, GpuError>,
) -> Result<T, GpuError> {
    use wgpu::ErrorFilter::{Internal, OutOfMemory, Validation};
    let scopes = [Validation, Internal, OutOfMemory].map(|filter| device.push_error_scope(filter));
    let done = work();
    // Scopes close in reverse order. All must be closed before the first error is returned.
    let errors: Vec<_> = scopes.into_iter().rev().filter_map(|scope| pollster::block_on(scope.pop())).collect();
    match errors.first() {
        Some(error) => Err(GpuError::Failed(error.to_string())),
        None => done,
    }
}
