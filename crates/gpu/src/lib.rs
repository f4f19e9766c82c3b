//! Relaxation and multigrid of five-point problems among walls on a GPU.
//!
//! The problem: a rectangle of cells, some with given values, the others each a mean of its four neighbours with weights of its own
//! (Laplace's equation, with or without drift), or that mean and a part of the slope. Rows and columns may be circles, end at walls, or
//! at mirrors.
//!
//! - [`Gpu::open`]: the adapter, by Vulkan, Metal or Direct3D 12; a clear error where there is none.
//! - [`Gpu::relax`]: Jacobi's, weighted Jacobi's, Gauss-Seidel's and SOR's relaxations, sweep by sweep until a rule is met.
//! - [`Gpu::solve`]: multigrid for the linear ones, refined to double precision.
//!
//! ```no_run
//! use cplan_gpu::*;
//!
//! // A row between 1 and 0: the values in between are on a straight line.
//! let unknown = vec![false, true, true, false];
//! let problem = GridEquations::new([1, 4], [Edge::Mirror; 2], 0.0, vec![1.0, 0.0, 0.0, 0.0], unknown, Stencil::Weights(
//!     vec![[0.0, 0.0, 0.5, 0.5]; 4],
//! ))?;
//! let gpu = Gpu::open()?;
//! let relaxed = gpu.relax(&problem, &Settings { below: 1e-6, ..Settings::default() })?;
//! assert!((relaxed.values[1] - 2.0 / 3.0).abs() < 1e-4);
//! # Ok::<(), GpuError>(())
//! ```
//!
//! # How
//!
//! Red-black relaxations work on two grids of half the width, one a colour: cell `(i, j)` is place `j / 2` of row `i` of colour
//! `(i + j) mod 2`, so that neighbouring threads read neighbouring numbers (Silva 2011). A sweep is a dispatch a colour (and a few more on
//! circles of odd length, where neighbours across the seam have one colour: the later goes after the earlier, as one by one); changes are
//! added up in two passes, one in each block of 32 x 8 cells, one over the blocks. Blocks of 32 x 32, as in the source, are more than WebGPU
//! promises. The stopping rule is judged on the GPU after every sweep: no sweep is one too many, and the program waits for the GPU only
//! once in some dozens of sweeps.
//!
//! # What holds
//!
//! WGSL has no double precision. Relaxed values are `f32`: each update is off by a few parts in 10^7 of its greatest neighbour, and values
//! below 10^-38 are 0. A relaxation that can come no further says so ([`Ending::Floor`]). Multigrid's corrections are `f32`, too, but the
//! residuals that they are for are reckoned in `f64` on the CPU: its solution is as good as one in `f64`.
//! The same input on the same adapter and driver gives the same bytes; another driver may round otherwise.

mod buffers;
mod cycle;
mod gpu;
mod half;
mod levels;
mod multigrid;
mod grid_equations;
mod relax;
mod rule;

pub use gpu::{Gpu, GpuError};
pub use grid_equations::{Edge, GridEquations, Stencil};
pub use multigrid::{Multigrid, Solution};
pub use relax::Relaxed;
pub use rule::{Ending, Measure, Settings, Sweep};
