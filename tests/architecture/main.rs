//! The source text itself: who imports whom.

mod imports;
