//! Code that tests, benchmarks and examples share: arms, scenes and problems made in code, random worlds, oracles, and published
//! results that the examples reproduce.
//!
//! The oracles share no code with the library, except the types of its input.

#[cfg(feature = "cplan")]
pub mod arms;
#[cfg(feature = "cplan")]
pub mod course;
#[cfg(feature = "cplan")]
pub mod flood;
#[cfg(feature = "cplan")]
pub mod follow_oracle;
#[cfg(feature = "cplan")]
pub mod football;
#[cfg(feature = "program")]
pub mod judged;
#[cfg(feature = "cplan")]
pub mod mobile;
#[cfg(feature = "cplan")]
pub mod moving;
#[cfg(feature = "cplan")]
pub mod oracle;
pub mod parry;
#[cfg(feature = "cplan")]
pub mod pictures;
#[cfg(feature = "cplan")]
pub mod problems;
#[cfg(feature = "cplan")]
pub mod published;
#[cfg(feature = "cplan")]
pub mod reference;
#[cfg(feature = "cplan")]
pub mod replay;
#[cfg(feature = "cplan")]
pub mod roadmap;
#[cfg(feature = "cplan")]
pub mod scenes;
pub mod shapes;
#[cfg(feature = "cplan")]
pub mod shipped;
#[cfg(feature = "cplan")]
pub mod solid;
#[cfg(feature = "cplan")]
pub mod suite;
#[cfg(feature = "cplan")]
pub mod world;
#[cfg(feature = "cplan")]
pub mod world_reference;

/// Returns the root folder of the repository.
pub fn root() -> &'static std::path::Path {
    let own = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    own.ancestors().nth(2).expect("this crate is in crates/testkit")
}
