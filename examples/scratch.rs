use cplan::cspace::{Grid, Proves};
use cplan::field::*;
use cplan::space::{Axis, Topology};
use std::time::Instant;
fn rng(s: &mut u64) -> u64 { *s ^= *s << 13; *s ^= *s >> 7; *s ^= *s << 17; *s }
fn grid(n: usize, torus: bool, blocked: Vec<bool>) -> Grid {
    let a = if torus { Axis::Circle } else { Axis::Interval { lower: 0.0, upper: n as f64 } };
    Grid { topology: Topology { axes: [a; 2] }, proves: Proves::Sampled, cells: [n, n], blocked }
}
fn maze(n: usize, loops: u64) -> Vec<bool> {
    let m = (n + 1) / 2; let mut b = vec![true; n * n]; let mut s = 88172645463325252;
    let mut seen = vec![false; m * m]; let mut st = vec![0usize]; seen[0] = true; b[0] = false;
    while let Some(&c) = st.last() {
        let (i, j) = (c / m, c % m); let mut o = vec![];
        for (di, dj) in [(0i64, 1i64), (1, 0), (0, -1), (-1, 0)] { let (x, y) = (i as i64 + di, j as i64 + dj);
            if x >= 0 && y >= 0 && (x as usize) < m && (y as usize) < m && !seen[x as usize * m + y as usize] { o.push((x as usize, y as usize)); } }
        if o.is_empty() { st.pop(); continue; }
        let (x, y) = o[(rng(&mut s) % o.len() as u64) as usize];
        seen[x * m + y] = true; b[2 * x * n + 2 * y] = false; b[(i + x) * n + j + y] = false; st.push(x * m + y);
    }
    if loops > 0 { for i in 0..n { for j in 0..n { if (i + j) % 2 == 1 && rng(&mut s) % 1000 < loops { b[i * n + j] = false; } } } }
    b
}
fn spiral(n: i64) -> Vec<bool> {
    let mut free = vec![false; (n * n) as usize]; let (mut i, mut j) = (0, 0); free[0] = true; let mut turns = 0;
    for (di, dj) in [(0, 1), (1, 0), (0, -1), (-1, 0)].into_iter().cycle() {
        let f = |i: i64, j: i64, free: &[bool]| (0..n).contains(&i) && (0..n).contains(&j) && free[(i * n + j) as usize];
        let before = (i, j);
        while (0..n).contains(&(i + di)) && (0..n).contains(&(j + dj)) && !f(i + 2 * di, j + 2 * dj, &free) { (i, j) = (i + di, j + dj); free[(i * n + j) as usize] = true; }
        turns = if before == (i, j) { turns + 1 } else { 0 }; if turns == 2 { break; }
    }
    free.into_iter().map(|f| !f).collect()
}
fn boxes(n: usize) -> Vec<bool> {
    let corner = |k: usize, by: f64| (k as f64 * by).fract() * n as f64;
    let mut blocked = vec![false; n * n];
    for k in 0..25 {
        let (top, left) = (corner(k, 0.618_034) as usize, corner(k, 0.754_878) as usize);
        let (height, width) = (n * (3 + k % 7) / 100, n * (3 + k % 5) / 100);
        for i in top..(top + height).min(n) { blocked[i * n + left..i * n + (left + width).min(n)].fill(true); }
    }
    blocked
}
fn serpent(n: usize, w: usize) -> Vec<bool> {
    (0..n * n).map(|c| { let (i, j) = (c / n, c % n); let k = i / (w + 1); i % (w + 1) == w && !(if k % 2 == 0 { j + w >= n } else { j < w }) }).collect()
}
fn random(n: usize, per: u64) -> Vec<bool> { let mut s = 1234567891234567; (0..n * n).map(|_| rng(&mut s) % 100 < per).collect() }
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let n: usize = a[2].parse().unwrap(); let p: u64 = a.get(3).map_or(0, |x| x.parse().unwrap());
    let b = match &a[1][..] { "maze" => maze(n, p), "spiral" => spiral(n as i64), "boxes" => boxes(n), "random" => random(n, p), "serpent" => serpent(n, p as usize), "open" => vec![false; n * n], _ => panic!() };
    let g = grid(n, a[1] == "boxes" || a[1]=="open", b);
    let free: Vec<usize> = (0..g.blocked.len()).filter(|&c| !g.blocked[c]).collect();
    let goal = if a[1] == "boxes" || a[1] == "random" { free[free.len() / 2] } else { free[0] };
    let t = Instant::now(); let l = Lattice::new(&g); let w = l.wave(&[goal]); let c = Component::new(&l, &w);
    println!("free {} reached {} component {:?}", free.len(), c.len(), t.elapsed());
    let t = Instant::now(); let f = harmonic(&c); let e = t.elapsed();
    let lo = (0..c.len()).map(|i| f.potential.ln(i)).fold(0.0, f64::min);
    println!("windows {} time {:?} = {:.0} ns/cell, least ln {lo}, residual {:.2e}, navigates {}", f.windows, e, e.as_nanos() as f64 / c.len() as f64, residual(&c, &f.potential), f.potential.navigates(&c));
}
