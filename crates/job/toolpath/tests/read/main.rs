//! Tests of lines: from G-code, from SVG outlines, and through given points.

mod gcode;
mod shapes;
mod svg;
