// Each cell of a colour goes towards what its neighbours ask for. `at(place)` reads a value.

struct Turn { colour: u32, region: u32, slot: u32, unused: u32 }

@group(0) @binding(1) var<uniform> turn: Turn;
@group(0) @binding(2) var<storage, read_write> values: array<f32>;
@group(0) @binding(4) var<storage, read> coefficients: array<f32>;
@group(0) @binding(5) var<storage, read> unknown: array<u32>;

fn place(i: u32, j: u32) -> u32 {
  return (((i + j) & 1u) * rule.rows + i) * rule.half + (j >> 1u);
}

fn beyond(edge: u32, own: f32, across: u32) -> f32 {
  if (edge == CIRCLE) { return at(across); }
  return select(own, rule.outside, edge == WALL);
}

fn around(i: u32, j: u32, own: f32) -> vec4<f32> {
  var near: vec4<f32>;
  if (i > 0u) { near.x = at(place(i - 1u, j)); } else { near.x = beyond(rule.edge_rows, own, place(rule.rows - 1u, j)); }
  if (i + 1u < rule.rows) { near.y = at(place(i + 1u, j)); } else { near.y = beyond(rule.edge_rows, own, place(0u, j)); }
  if (j > 0u) { near.z = at(place(i, j - 1u)); } else { near.z = beyond(rule.edge_columns, own, place(i, rule.columns - 1u)); }
  if (j + 1u < rule.columns) { near.w = at(place(i, j + 1u)); } else { near.w = beyond(rule.edge_columns, own, place(i, 0u)); }
  return near;
}

fn asked(here: u32, near: vec4<f32>) -> f32 {
  let mean = 0.25 * ((near.x + near.y) + (near.z + near.w));
  if (rule.stencil == 0u) { return mean; }
  if (rule.stencil == 2u) { return mean + coefficients[here] * 0.5 * (abs(near.y - near.x) + abs(near.w - near.z)); }
  let plane = 2u * rule.rows * rule.half;
  let weights = vec4(coefficients[here], coefficients[plane + here], coefficients[2u * plane + here],
                     coefficients[3u * plane + here]);
  return (weights.x * near.x + weights.y * near.y) + (weights.z * near.z + weights.w * near.w);
}

// Whether it is no number, or will not come back.
fn is_lost(value: f32) -> bool {
  return (bitcast<u32>(value) & 0x7f800000u) == 0x7f800000u || abs(value) > rule.beyond;
}

fn measured(change: f32, value: f32) -> vec2<f32> {
  if (change == 0.0) { return vec2(0.0); }
  let relative = select(min(change / abs(value), GREATEST), GREATEST, value == 0.0);
  switch rule.measure {
    case 1u: { return vec2(change * change, relative); }
    case 3u: { return vec2(relative, relative); }
    default: { return vec2(change, relative); }
  }
}

@compute @workgroup_size(32, 8)
fn sweep(@builtin(global_invocation_id) id: vec3<u32>, @builtin(local_invocation_index) lane: u32,
         @builtin(workgroup_id) block: vec3<u32>, @builtin(num_workgroups) blocks: vec3<u32>) {
  let i = id.y;
  let j = 2u * id.x + ((i + turn.colour) & 1u);
  var seen = vec2(0.0);
  if (state.done == 0u && i < rule.rows && j < rule.columns) {
    let here = place(i, j);
    // Cells at the end of a circle of odd length go after those at its beginning.
    let late_row = select(0u, 1u, (rule.odd & 1u) != 0u && i + 1u == rule.rows);
    let late_column = select(0u, 2u, (rule.odd & 2u) != 0u && j + 1u == rule.columns);
    if (late_row + late_column == turn.region && (unknown[here >> 5u] >> (here & 31u) & 1u) == 1u) {
      let own = at(here);
      let wanted = asked(here, around(i, j, own));
      // With factor 1 exactly what is asked, without the rounding of a detour.
      let gone = select(own + rule.factor * (wanted - own), wanted, rule.factor == 1.0);
      let next = min(max(gone, rule.low), rule.high);
      values[here] = next;
      seen = measured(abs(next - own), next);
      if (is_lost(next)) { atomicStore(&state.lost, 1u); }
    }
  }
  let all = total(lane, seen);
  if (lane == 0u) { partials[turn.slot + block.y * blocks.x + block.x] = all; }
}
