//! Mazes and spirals with corridors one cell wide, on `n x n` cells (`n` odd), row by row, with true for a blocked
//! cell.

/// Returns a pseudorandom number (xorshift, Marsaglia 2003).
fn random(state: &mut u64) -> u64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    *state
}

/// Returns a maze without loops, made by depth-first search over the cells with even coordinates. Afterwards,
/// `openings` of every thousand walls between two corridors are opened.
pub fn maze(n: usize, openings: u64) -> Vec<bool> {
    let rooms = n.div_ceil(2);
    let mut state = 88_172_645_463_325_252;
    let mut blocked = vec![true; n * n];
    blocked[0] = false;
    let mut stack = vec![[0, 0]];
    while let Some(&[i, j]) = stack.last() {
        let steps: [[usize; 2]; 4] = [[i, j + 1], [i + 1, j], [i, j.wrapping_sub(1)], [i.wrapping_sub(1), j]];
        let is_open = |&[i, j]: &[usize; 2]| i < rooms && j < rooms && blocked[2 * i * n + 2 * j];
        let next: Vec<[usize; 2]> = steps.into_iter().filter(is_open).collect();
        if next.is_empty() {
            stack.pop();
            continue;
        }
        let [k, l] = next[(random(&mut state) % next.len() as u64) as usize];
        blocked[2 * k * n + 2 * l] = false;
        blocked[(i + k) * n + j + l] = false;
        stack.push([k, l]);
    }
    for (cell, blocked) in blocked.iter_mut().enumerate() {
        if (cell / n + cell % n) % 2 == 1 && random(&mut state) % 1000 < openings {
            *blocked = false;
        }
    }
    blocked
}

/// Returns the blocked cells of a corridor that winds inwards, and the cell at its inner end. The outer end is cell 0.
pub fn spiral(n: usize) -> (Vec<bool>, usize) {
    let n = n as i64;
    let mut blocked = vec![true; (n * n) as usize];
    blocked[0] = false;
    let (mut i, mut j, mut turns) = (0, 0, 0);
    for (di, dj) in [(0, 1), (1, 0), (0, -1), (-1, 0)].into_iter().cycle() {
        let before = (i, j);
        let inside = |i: i64, j: i64| (0..n).contains(&i) && (0..n).contains(&j);
        let is_free = |i: i64, j: i64, blocked: &[bool]| inside(i, j) && !blocked[(i * n + j) as usize];
        // Continue as long as the corridor does not run next to itself.
        while inside(i + di, j + dj) && !is_free(i + 2 * di, j + 2 * dj, &blocked) {
            (i, j) = (i + di, j + dj);
            blocked[(i * n + j) as usize] = false;
        }
        turns = if before == (i, j) { turns + 1 } else { 0 };
        if turns == 2 {
            break;
        }
    }
    (blocked, (i * n + j) as usize)
}
