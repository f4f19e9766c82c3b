//! Cycles of multigrid, as lists of dispatches.

use super::buffers::blocks;
use super::levels::Level;
use super::relax::turns;
use super::{Gpu, GpuError, GridEquations};
use cplan_fields::Boundary;

/// Number of sweeps before and after each correction.
const SMOOTHING_SWEEPS: usize = 2;

/// Number of sweeps on the coarsest grid, which has at most 8 x 8 cells.
const COARSEST_SWEEPS: usize = 32;

/// Parameters of a level for the kernels, in the order of `Level` in `kernels/levels.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Shape {
    rows: u32,
    columns: u32,
    coarse_rows: u32,
    coarse_columns: u32,
    odd: u32,
    mirrors: u32,
    colour: u32,
    region: u32,
}

/// A level on the GPU.
struct Stage {
    /// One bind group per turn of a sweep.
    smooth: Vec<wgpu::BindGroup>,
    smooth_blocks: [u32; 2],
    /// The next coarser level, and the transfers to it and back. `None` for the coarsest level.
    next: Option<Next>,
}

struct Next {
    restrict: wgpu::BindGroup,
    restrict_blocks: [u32; 2],
    prolong: wgpu::BindGroup,
    prolong_blocks: [u32; 2],
}

/// All levels on the GPU, with their variables.
pub(super) struct Cycle {
    stages: Vec<Stage>,
    /// Correction on the finest level, the result of a cycle. The next field is its right-hand side.
    pub x: wgpu::Buffer,
    pub right: wgpu::Buffer,
}

impl Cycle {
    pub fn new(gpu: &Gpu, levels: &[Level]) -> Result<Self, GpuError> {
        let nothing = |level: &Level| gpu.storage(&vec![0.0_f32; level.own.len()]);
        let xs = levels.iter().map(nothing).collect::<Result<Vec<_>, _>>()?;
        let rights = levels.iter().map(nothing).collect::<Result<Vec<_>, _>>()?;
        let ws = levels.iter().map(|level| gpu.storage(&level.planes())).collect::<Result<Vec<_>, _>>()?;
        let stage = |k: usize| {
            let level = &levels[k];
            let coarse = levels.get(k + 1).map_or([0; 2], |coarse| coarse.cells);
            let odd = GridEquations::odd_circles(level.cells, level.boundaries);
            let mirrors = u32::from(level.boundaries[0] == Boundary::Reflecting)
                + 2 * u32::from(level.boundaries[1] == Boundary::Reflecting);
            let [rows, columns] = level.cells.map(|n| n as u32);
            let [coarse_rows, coarse_columns] = coarse.map(|n| n as u32);
            let shape = Shape { rows, columns, coarse_rows, coarse_columns, odd, mirrors, colour: 0, region: 0 };
            let smooth = turns(odd, 0).into_iter().map(|turn| {
                let shape = gpu.uniform(&Shape { colour: turn.colour, region: turn.region, ..shape });
                gpu.group(&gpu.pipelines.smooth, &[(0, &shape), (1, &xs[k]), (2, &rights[k]), (3, &ws[k])])
            });
            let next = levels.get(k + 1).map(|coarse| {
                let shape = gpu.uniform(&shape);
                let down =
                    [(0, &shape), (1, &xs[k]), (2, &rights[k]), (3, &ws[k]), (4, &rights[k + 1]), (5, &xs[k + 1])];
                let up = [(0, &shape), (1, &xs[k]), (3, &ws[k]), (5, &xs[k + 1]), (6, &ws[k + 1])];
                Next {
                    restrict: gpu.group(&gpu.pipelines.restrict, &down),
                    restrict_blocks: blocks(coarse.cells[1], coarse.cells[0]),
                    prolong: gpu.group(&gpu.pipelines.prolong, &up),
                    prolong_blocks: blocks(level.cells[1], level.cells[0]),
                }
            });
            Stage { smooth: smooth.collect(), smooth_blocks: blocks(level.cells[1].div_ceil(2), level.cells[0]), next }
        };
        let stages = (0..levels.len()).map(stage).collect();
        Ok(Self { stages, x: xs[0].clone(), right: rights[0].clone() })
    }

    /// Records one F-cycle: on each coarser level an F-cycle, then a V-cycle. `O(cells)` work in `O(log^2 cells)`
    /// dispatches.
    ///
    /// The coarse equations are approximate, so V-cycles alone would need more cycles on larger grids.
    pub fn record(&self, gpu: &Gpu, pass: &mut wgpu::ComputePass) {
        self.descend(gpu, pass, 0, true);
    }

    fn descend(&self, gpu: &Gpu, pass: &mut wgpu::ComputePass, level: usize, is_full: bool) {
        let stage = &self.stages[level];
        let Some(next) = &stage.next else {
            stage.smooth(gpu, pass, COARSEST_SWEEPS, false);
            return;
        };
        stage.smooth(gpu, pass, SMOOTHING_SWEEPS, false);
        run(pass, &gpu.pipelines.restrict, &next.restrict, next.restrict_blocks);
        self.descend(gpu, pass, level + 1, is_full);
        if is_full {
            self.descend(gpu, pass, level + 1, false);
        }
        run(pass, &gpu.pipelines.prolong, &next.prolong, next.prolong_blocks);
        stage.smooth(gpu, pass, SMOOTHING_SWEEPS, true);
    }
}

impl Stage {
    fn smooth(&self, gpu: &Gpu, pass: &mut wgpu::ComputePass, sweeps: usize, is_backward: bool) {
        let turn = |group: &wgpu::BindGroup| run(pass, &gpu.pipelines.smooth, group, self.smooth_blocks);
        let count = sweeps * self.smooth.len();
        let order = (0..count).map(|k| if is_backward { count - 1 - k } else { k });
        order.map(|k| &self.smooth[k % self.smooth.len()]).for_each(turn);
    }
}

fn run(pass: &mut wgpu::ComputePass, kernel: &wgpu::ComputePipeline, group: &wgpu::BindGroup, blocks: [u32; 2]) {
    pass.set_pipeline(kernel);
    pass.set_bind_group(0, group, &[]);
    pass.dispatch_workgroups(blocks[0], blocks[1], 1);
}
