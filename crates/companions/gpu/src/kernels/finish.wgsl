// The second pass of the sum over all cells, and the stopping rule.

const CONVERGED = 1u;
const FLOOR = 2u;
const UNCONVERGED = 3u;
const DIVERGED = 4u;

@compute @workgroup_size(256)
fn finish(@builtin(local_invocation_index) lane: u32) {
  var own = vec2(0.0);
  for (var block = lane; block < rule.blocks; block += 256u) { own = joined(own, partials[block]); }
  let all = total(lane, own);
  if (lane == 0u && state.done == 0u) {
    var change = all.x;
    if (rule.measure == 4u) {
      change = select(abs(all.x - state.before), GREATEST, state.sweeps == 0u);
      state.before = all.x;
    }
    state.change = change;
    state.sweeps += 1u;
    if (all.y > rule.rounding) {
      state.since = 0u;
      state.least = GREATEST;
    } else if (change < state.least) {
      state.since = 0u;
      state.least = change;
    } else {
      state.since += 1u;
    }
    if (atomicLoad(&state.lost) != 0u) {
      state.done = DIVERGED;
    } else if (change < rule.below || all.y == 0.0) {
      state.done = CONVERGED;
    } else if (state.since >= rule.patience) {
      state.done = FLOOR;
    } else if (state.sweeps >= rule.max_sweeps) {
      state.done = UNCONVERGED;
    }
  }
}
