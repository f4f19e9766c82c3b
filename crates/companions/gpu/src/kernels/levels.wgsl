// The steps of multigrid's cycles: cells row by row, five planes of coefficients (four neighbours, and the cell's own, 0 where nothing
// is sought).

struct Level {
  rows: u32, columns: u32, coarse_rows: u32, coarse_columns: u32,
  odd: u32, mirrors: u32, colour: u32, region: u32,
}

@group(0) @binding(0) var<uniform> level: Level;
@group(0) @binding(1) var<storage, read_write> x: array<f32>;
@group(0) @binding(2) var<storage, read> right: array<f32>;
@group(0) @binding(3) var<storage, read> w: array<f32>;
@group(0) @binding(4) var<storage, read_write> coarse_right: array<f32>;
@group(0) @binding(5) var<storage, read_write> coarse_x: array<f32>;
@group(0) @binding(6) var<storage, read> coarse_w: array<f32>;

// Right-hand side and what the neighbours add to it. Neighbours that are none have the weight 0.
fn around(i: u32, j: u32) -> f32 {
  let n = level.rows * level.columns;
  let here = i * level.columns + j;
  let above = select(i, level.rows, i == 0u) - 1u;
  let below = select(i + 1u, 0u, i + 1u == level.rows);
  let before = select(j, level.columns, j == 0u) - 1u;
  let after = select(j + 1u, 0u, j + 1u == level.columns);
  let rows = w[here] * x[above * level.columns + j] + w[n + here] * x[below * level.columns + j];
  let columns = w[2u * n + here] * x[i * level.columns + before] + w[3u * n + here] * x[i * level.columns + after];
  return right[here] + (rows + columns);
}

@compute @workgroup_size(32, 8)
fn relax(@builtin(global_invocation_id) id: vec3<u32>) {
  let i = id.y;
  let j = 2u * id.x + ((i + level.colour) & 1u);
  if (i >= level.rows || j >= level.columns) { return; }
  let late_row = select(0u, 1u, (level.odd & 1u) != 0u && i + 1u == level.rows);
  let late_column = select(0u, 2u, (level.odd & 2u) != 0u && j + 1u == level.columns);
  let here = i * level.columns + j;
  let own = w[4u * level.rows * level.columns + here];
  if (late_row + late_column == level.region && own > 0.0) { x[here] = around(i, j) / own; }
}

// What is left to do of the four cells of a coarse one.
@compute @workgroup_size(32, 8)
fn coarsen(@builtin(global_invocation_id) id: vec3<u32>) {
  if (id.y >= level.coarse_rows || id.x >= level.coarse_columns) { return; }
  var left = 0.0;
  for (var child = 0u; child < 4u; child++) {
    let i = 2u * id.y + (child >> 1u);
    let j = 2u * id.x + (child & 1u);
    if (i < level.rows && j < level.columns) {
      let here = i * level.columns + j;
      let own = w[4u * level.rows * level.columns + here];
      if (own > 0.0) { left += around(i, j) - own * x[here]; }
    }
  }
  let coarse = id.y * level.coarse_columns + id.x;
  coarse_right[coarse] = left;
  coarse_x[coarse] = 0.0;
}

// The value of a coarse neighbour: 0 at walls, the cell's own beyond mirrors.
fn coarse_at(coarse: u32, side: u32, neighbour: u32, mirror: bool) -> f32 {
  if (mirror) { return coarse_x[coarse]; }
  return select(0.0, coarse_x[neighbour], coarse_w[side * level.coarse_rows * level.coarse_columns + coarse] > 0.0);
}

@compute @workgroup_size(32, 8)
fn prolong(@builtin(global_invocation_id) id: vec3<u32>) {
  let i = id.y;
  let j = id.x;
  if (i >= level.rows || j >= level.columns) { return; }
  let here = i * level.columns + j;
  if (w[4u * level.rows * level.columns + here] == 0.0) { return; }
  let a = i >> 1u;
  let b = j >> 1u;
  let coarse = a * level.coarse_columns + b;
  // The nearer coarse row and column.
  let down = (i & 1u) == 1u;
  let after = (j & 1u) == 1u;
  let last_row = a + 1u == level.coarse_rows;
  let last_column = b + 1u == level.coarse_columns;
  let row = select(select(a, level.coarse_rows, a == 0u) - 1u, select(a + 1u, 0u, last_row), down);
  let column = select(select(b, level.coarse_columns, b == 0u) - 1u, select(b + 1u, 0u, last_column), after);
  let row_mirror = (level.mirrors & 1u) != 0u && select(a == 0u, last_row, down);
  let column_mirror = (level.mirrors & 2u) != 0u && select(b == 0u, last_column, after);
  let vertical = coarse_at(coarse, select(0u, 1u, down), row * level.coarse_columns + b, row_mirror);
  let horizontal = coarse_at(coarse, select(2u, 3u, after), a * level.coarse_columns + column, column_mirror);
  x[here] += 0.5 * coarse_x[coarse] + 0.25 * (vertical + horizontal);
}
