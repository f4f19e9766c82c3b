//! Relaxation and multigrid of five-point problems among walls on a GPU.
//!
//! The problem is a rectangle of cells. Some have given values. The value of any other cell is a weighted mean of its
//! four neighbours (Laplace's equation, with or without drift), or their mean plus a fraction of the slope. Rows and
//! columns may be circles, or end at walls or mirrors.
//!
//! - [`Gpu::open`] opens the adapter through Vulkan, Metal or Direct3D 12, or returns a clear error.
//! - [`Gpu::relax`] runs Jacobi, weighted Jacobi, Gauss-Seidel or SOR relaxation until a stopping rule holds.
//! - [`shared`] makes it available for fields, as [`cplan_fields::Device::Gpu`].
//! - [`Gpu::solve`] solves linear problems by multigrid, refined to double precision.
//!
//! ```no_run
//! use cplan_fields::{Boundary, CellEquations, Measure, Order, Relaxation, Stopping};
//! use cplan_gpu::{Gpu, GpuError, GridEquations};
//!
//! // A row between 1 and 0: the values in between are on a straight line.
//! let unknown = vec![false, true, true, false];
//! let equations = CellEquations::Weights(vec![[0.0, 0.0, 0.5, 0.5]; 4]);
//! let ends = [Boundary::Reflecting; 2];
//! let problem = GridEquations::new([1, 4], ends, 0.0, vec![1.0, 0.0, 0.0, 0.0], unknown, equations)?;
//! let stopping = Stopping { measure: Measure::SumOfSquares, below: 1e-6, max_sweeps: 10_000 };
//! let relaxed = Gpu::open()?.relax(&problem, &Relaxation::gauss_seidel(Order::RedBlack), &stopping)?;
//! assert!((relaxed.values[1] - 2.0 / 3.0).abs() < 1e-4);
//! # Ok::<(), GpuError>(())
//! ```
//!
//! # Method
//!
//! Red-black relaxations store each colour as a grid of half the width. Cell `(i, j)` is place `j / 2` of row `i` of
//! colour `(i + j) mod 2`, so neighbouring threads read neighbouring numbers (Silva 2011). A sweep takes one dispatch
//! per colour. Circles of odd length need a few more, because neighbours across the seam have the same colour and must
//! be updated one after the other.
//!
//! Changes are summed in two passes: within each block of 32 x 8 cells, then over the blocks. The source's blocks of 32
//! x 32 exceed the limits that WebGPU guarantees. The GPU evaluates the stopping rule after every sweep, so it runs no
//! extra sweeps, and the program waits for the GPU only once per several dozen sweeps.
//!
//! # Guarantees
//!
//! WGSL has no double precision. Relaxed values are `f32`: each update has an error of a few parts in 10^7 of its
//! greatest neighbour, and values below 10^-38 are 0. A relaxation that cannot improve further ends with
//! [`Ending::Floor`]. Multigrid corrections are also `f32`, but their residuals are computed in `f64` on the CPU, so
//! the solution is as good as one computed in `f64`.
//!
//! The same input on the same adapter and driver gives the same bytes. Another driver may round differently.

mod accelerator;
mod buffers;
mod cycle;
mod gpu;
mod half;
mod levels;
mod multigrid;
mod grid_equations;
mod relax;
mod rule;

pub use accelerator::shared;
pub use gpu::{Gpu, GpuError};
pub use grid_equations::GridEquations;
pub use multigrid::{Multigrid, Solution};
pub use relax::RelaxedField;
pub use rule::Ending;
