//! The course as pages that need no server and no network: chapters with figures, exercise sheets without answers, and the
//! answers in a folder of their own, which a teacher may withhold.
//!
//! ```text
//! docs/*.md -> Chapter -> Page (HTML)
//! ```
//!
//! The caller makes the live figures: each chapter has the command that writes its figure ([`Chapter::figure`]).

mod chapter;
mod html;
mod page;

pub use chapter::{Chapter, Figure};
pub use page::{CourseFile, files};
