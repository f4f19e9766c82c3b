//! A match of robots that are guided by fields: the play, the cost of its fields, and the page that replays it.

pub mod measure;
pub mod page;
pub mod play;
