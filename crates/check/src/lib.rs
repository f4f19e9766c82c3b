//! x
#![forbid(unsafe_code)]
mod decimal;
mod interval;
mod overlap;
mod polygon;
mod sweep;
