// What a relaxation goes by, and where cells lie.

struct Rule {
  rows: u32, columns: u32, half: u32, edge_rows: u32,
  edge_columns: u32, odd: u32, stencil: u32, measure: u32,
  max_sweeps: u32, blocks: u32, outside: f32, factor: f32,
  low: f32, high: f32, below: f32, beyond: f32,
  rounding: f32, patience: u32, unused: vec2<u32>,
}

struct State {
  done: u32, sweeps: u32, lost: atomic<u32>, since: u32,
  change: f32, before: f32, least: f32, unused: f32,
}

@group(0) @binding(0) var<uniform> rule: Rule;
@group(0) @binding(6) var<storage, read_write> partials: array<vec2<f32>>;
@group(0) @binding(7) var<storage, read_write> state: State;

const CIRCLE = 0u;
const WALL = 1u;
const GREATEST = 3.4028234e38;

// The measure so far and the greatest relative change, of two parts.
fn joined(a: vec2<f32>, b: vec2<f32>) -> vec2<f32> {
  let largest = max(a, b);
  let is_sum = rule.measure != 2u && rule.measure != 3u;
  return vec2(select(largest.x, a.x + b.x, is_sum), largest.y);
}

var<workgroup> parts: array<vec2<f32>, 256>;

// Of all threads of a block, in its first.
fn total(lane: u32, own: vec2<f32>) -> vec2<f32> {
  parts[lane] = own;
  for (var stride = 128u; stride > 0u; stride /= 2u) {
    workgroupBarrier();
    if (lane < stride) { parts[lane] = joined(parts[lane], parts[lane + stride]); }
  }
  return parts[lane];
}
