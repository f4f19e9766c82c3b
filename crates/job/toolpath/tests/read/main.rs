//! Tests of lines: from G-code, and through given points.

mod gcode;
mod shapes;
