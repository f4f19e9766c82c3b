# What is run by hand. `.ci/run` is what a clean clone has to pass, and needs no just.

# All of them
default:
    @just --list

# Formatting and lints, with all features and with none
check:
    cargo fmt --all --check
    cargo clippy --locked --workspace --exclude cplan-fuzz --all-targets --all-features -- -D warnings
    cargo clippy --locked --all-targets --no-default-features -- -D warnings

# All tests, or those of a program: just test --test planning
test *WHICH:
    cargo test --locked {{WHICH}}

# Recordings by the format's own readers, pages in a browser
browser:
    cargo build --locked
    .ci/browser

# The live page without a server, in target/page
page:
    cargo build --locked
    .ci/page

# The fuzz targets, built and run over their seeds, without the nightly toolchain
fuzz:
    .ci/fuzz

# Relaxation on a GPU, or a driver in software; and Parquet
gpu:
    .ci/gpu

# The Python package: wheel, tests, stubs
python:
    .ci/python

# The Python package without an extension module, as WebAssembly: wheel, tests, in CPython and in Pyodide
wheel:
    cargo build --locked
    .ci/wheel

# Licences, bans and duplicates of dependencies (needs cargo-deny)
deny:
    cargo deny --locked check

# All benchmarks, or one: just bench slabs
bench NAME="":
    cargo bench --locked {{ if NAME == "" { "" } else { "--bench " + NAME } }}

# The pictures of the documentation, drawn again; those of pages need what .ci/browser installs
pictures:
    cargo run --locked --release --example pictures
    cargo build --locked
    CPLAN_WRITE_PICTURES=1 target/python/bin/python -m pytest -q tests/browser/test_front_page.py

# Schemas of files, reference of world files, the pages of the library; and the book, where mdBook is installed
docs:
    CPLAN_WRITE_SCHEMAS=1 cargo test --locked --lib -p cplan-world -p cplan-study -p cplan-view the_schema_agrees_with_its_file
    cargo run --locked --example world_reference
    RUSTDOCFLAGS="-D warnings" cargo doc --locked --no-deps
    .ci/book
