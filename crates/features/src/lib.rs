//! One set of features for the packages that all builds of cplan share. This crate has no code.
//!
//! Cargo compiles a package once for each set of features. Tests, the fuzz targets and the Python package ask for a few
//! more features of packages at the bottom of the tree (`num-rational` with large integers, `syn` with more traits), and
//! everything above these would be compiled again for each of them. The program depends on this crate, whose manifest
//! names these features, so that `cargo run`, `cargo test`, `.ci/fuzz` and `.ci/python` share what they compile.
