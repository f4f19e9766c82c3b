//! The course as pages that need no server and no network: chapters with figures, exercise sheets without answers, and
//! a separate folder with the answers, which a teacher may withhold.
//!
//! ```text
//! docs/*.md -> Chapter -> Page (HTML)
//! ```
//!
//! The caller creates the live figures. Each chapter has the command for its figure ([`Chapter::figure`]).

mod chapter;
mod html;
mod page;

pub use chapter::{Chapter, Figure};
pub use page::{CourseFile, files};
