//! The cost of computing a match's fields, compared with the source (M. Oliveira da Silva 2011, tables 6.3 to 6.17; a CPU of
//! 2009).

use super::play::{CELLS, Frame, MOST, RATE, walls};
use cplan::field::{
    Boundary, Difference, Equation, Factor, Moment, MovingField, Order, RelaxError, Relaxation, Scan, Solver,
    ValueGuide, direction, drift_around_robots, eliminated,
};
use std::fmt;
use std::time::Instant;

/// Tolerance of the source: the sum of squared changes in a sweep must fall below this.
pub const PUBLISHED_BELOW: f64 = 1e-6;
/// One in this many frames is also solved from the initial field.
const STANDING: usize = 30;

/// The kinds of fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Laplace's equation, for the seeker of the blue team.
    Harmonic,
    /// The oriented field of the seeker of the blue team.
    Oriented,
    /// The field that the red robots share.
    LocallyOriented,
}

impl Kind {
    /// Returns the input from which the field is computed in a frame.
    pub fn moment(self, frame: &Frame) -> Moment {
        match self {
            Self::Harmonic => Moment { robots: Vec::new(), ..frame.moments[frame.seekers[0]].clone() },
            Self::Oriented => frame.moments[frame.seekers[0]].clone(),
            Self::LocallyOriented => frame.moments[3].clone(),
        }
    }
}

/// A line of the table: a field and its solution.
pub struct Case {
    /// The field.
    pub kind: Kind,
    /// The differences by which the equation is discretised.
    pub difference: Difference,
    /// The method that solves it.
    pub solver: Solver,
    /// Mean number of sweeps, and mean milliseconds, in the source.
    pub published: Option<[f64; 2]>,
}

/// Returns all cases, those of the source first.
pub fn cases() -> Vec<Case> {
    use Difference::{Central, Upwind};
    let published = [
        (Kind::Harmonic, Central, 1.9, [[19.40, 5.38], [17.65, 5.20]]),
        (Kind::Oriented, Central, 1.9, [[17.17, 8.04], [16.41, 8.20]]),
        (Kind::Oriented, Upwind, 1.5, [[23.54, 11.01], [16.34, 7.91]]),
        (Kind::LocallyOriented, Central, 1.8, [[20.43, 29.18], [20.52, 21.30]]),
        (Kind::LocallyOriented, Upwind, 1.7, [[28.44, 28.41], [17.16, 16.92]]),
    ];
    let mut cases = Vec::new();
    for (kind, difference, factor, counts) in published {
        for (factor, counts) in [1.0, factor].into_iter().zip(counts) {
            cases.push(Case { kind, difference, solver: sor(factor), published: Some(counts) });
        }
    }
    for kind in [Kind::Harmonic, Kind::Oriented, Kind::LocallyOriented] {
        cases.push(Case { kind, difference: Upwind, solver: Solver::Multigrid, published: None });
    }
    cases
}

/// Returns the settings of SOR row by row. With factor 1, this is Gauss-Seidel relaxation.
pub fn sor(factor: f64) -> Solver {
    Solver::Relaxation(Relaxation::sor(Factor::Given(factor), Order::Lines(Scan::ROWS)))
}

/// Returns the initial field, before the first frame.
pub fn standing(difference: Difference) -> Result<MovingField, RelaxError> {
    MovingField::new(CELLS, walls(), [Boundary::High; 2], difference)
}

/// Measures the CPU time of this thread, so that other load on the machine does not matter. If the system does not report it,
/// measures the time of day.
struct Clock {
    day: Instant,
    core: Option<f64>,
}

impl Clock {
    fn start() -> Self {
        Self { day: Instant::now(), core: Self::core() }
    }

    /// Returns the nanoseconds that this thread has run on a processor, as Linux reports them. `None` on other systems.
    fn core() -> Option<f64> {
        std::fs::read_to_string("/proc/thread-self/schedstat").ok()?.split(' ').next()?.parse().ok()
    }

    fn milliseconds(&self) -> f64 {
        let core = self.core.zip(Self::core()).map(|(from, to)| 1e-6 * (to - from));
        core.unwrap_or_else(|| 1e3 * self.day.elapsed().as_secs_f64())
    }
}

/// Figures of the fields of all frames.
#[derive(Clone, Copy, Debug, Default)]
pub struct Run {
    /// Number of fields.
    pub fields: usize,
    /// Number of frames that needed at most one sweep.
    pub at_once: usize,
    /// Number of sweeps, of all fields together.
    pub sweeps: usize,
    /// Mean milliseconds per field.
    pub milliseconds: f64,
}

impl Run {
    /// Returns the share of the fields that needed at most one sweep.
    pub fn share_at_once(&self) -> f64 {
        self.at_once as f64 / self.fields.max(1) as f64
    }

    /// Returns the mean number of sweeps per field.
    pub fn mean_sweeps(&self) -> f64 {
        self.sweeps as f64 / self.fields.max(1) as f64
    }
}

/// Solves the fields in sequence, each from the previous one, or all from the initial field.
pub fn run<'a>(
    moments: impl Iterator<Item = &'a Moment>,
    case: &Case,
    below: f64,
    from_standing: bool,
) -> Result<Run, RelaxError> {
    let first = standing(case.difference)?;
    let (mut field, mut run) = (first.clone(), Run::default());
    let clock = Clock::start();
    for moment in moments {
        if from_standing {
            field = first.clone();
        }
        let done = field.next(moment, &case.solver, below, MOST)?;
        run.fields += 1;
        run.at_once += usize::from(done.converged && done.sweeps <= 1);
        run.sweeps += done.sweeps;
    }
    run.milliseconds = clock.milliseconds() / run.fields.max(1) as f64;
    Ok(run)
}

/// A line of the table, with its results.
pub struct Row {
    /// The field, and how it is solved.
    pub case: Case,
    /// The fields of all frames, each from that of the previous frame.
    pub warm: Run,
    /// Fields from the initial field, of one in thirty frames.
    pub standing: Run,
}

impl Row {
    /// Solves the fields of these frames.
    pub fn new(case: Case, frames: &[Frame]) -> Result<Self, RelaxError> {
        let moments: Vec<Moment> = frames.iter().map(|frame| case.kind.moment(frame)).collect();
        let warm = run(moments.iter(), &case, PUBLISHED_BELOW, false)?;
        let standing = run(moments.iter().step_by(STANDING), &case, PUBLISHED_BELOW, true)?;
        Ok(Self { case, warm, standing })
    }
}

/// The head of the table.
pub const HEAD: &str = "                                   published          from the last frame       from nothing
field                             sweeps     ms   sweeps  at once     ms     sweeps     ms";

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = match self.case.kind {
            Kind::Harmonic => "CPH".to_owned(),
            Kind::Oriented => format!("CPO {:?}", self.case.difference).to_lowercase().replace("cpo", "CPO"),
            Kind::LocallyOriented => format!("CPLO {:?}", self.case.difference).to_lowercase().replace("cplo", "CPLO"),
        };
        let solver = match &self.case.solver {
            Solver::Multigrid => "multigrid".into(),
            Solver::Relaxation(relaxation) if relaxation.factor(CELLS) == 1.0 => "GS".into(),
            Solver::Relaxation(relaxation) => format!("SOR {}", relaxation.factor(CELLS)),
        };
        let published = self.case.published.map_or_else(
            || format!("{:>7}{:>7}", "-", "-"),
            |[sweeps, milliseconds]| format!("{sweeps:>7.2}{milliseconds:>7.2}"),
        );
        let Self { warm, standing, .. } = self;
        write!(
            f,
            "{kind:<13} {solver:<17} {published} {:>8.2} {:>7.1}% {:>6.2} {:>10.2} {:>6.2}",
            warm.mean_sweeps(),
            100.0 * warm.share_at_once(),
            warm.milliseconds,
            standing.mean_sweeps(),
            standing.milliseconds
        )
    }
}

/// Solves the fields of the red robots as if the strategy needed them `times` times per frame, although the camera sees a change
/// only once.
pub fn run_after_every_frame(frames: &[Frame], times: usize, case: &Case) -> Result<Run, RelaxError> {
    let moments: Vec<&Moment> = frames.iter().flat_map(|frame| std::iter::repeat_n(&frame.moments[3], times)).collect();
    run(moments.into_iter(), case, PUBLISHED_BELOW, false)
}

/// Returns the milliseconds per frame for all blue robots' own fields, and for the field that the red ones share, by central
/// differences and Gauss-Seidel relaxation from the previous frame.
pub fn three_and_one(frames: &[Frame]) -> Result<[f64; 2], RelaxError> {
    let case = |kind| Case { kind, difference: Difference::Central, solver: sor(1.0), published: None };
    let mut three = 0.0;
    for robot in 0..3 {
        let moments = frames.iter().map(|frame| &frame.moments[robot]);
        three += run(moments, &case(Kind::Oriented), PUBLISHED_BELOW, false)?.milliseconds;
    }
    let shared = frames.iter().map(|frame| &frame.moments[3]);
    Ok([three, run(shared, &case(Kind::LocallyOriented), PUBLISHED_BELOW, false)?.milliseconds])
}

/// A direction computed by elimination: the number of its frame, and the position of the seeker of the blue team.
pub struct Exact {
    frame: usize,
    at: [f64; 2],
    direction: [f64; 2],
}

/// One in this many frames is also solved by elimination.
const ELIMINATED: usize = 20;
/// A field counts as level if it differs from the obstacles' value by less than this. Its goal is then out of reach.
const LEVEL: f64 = 1e-12;

/// Returns the directions in the field of the seeker of the blue team, for frames in which the goal can be reached.
pub fn exact(frames: &[Frame]) -> Result<Vec<Exact>, RelaxError> {
    let mut found = Vec::new();
    for (k, frame) in frames.iter().enumerate().step_by(ELIMINATED) {
        let (moment, at) = (Kind::Oriented.moment(frame), frame.robots[frame.seekers[0]]);
        // The field is not relaxed, but provides the kind of each cell.
        let mut field = standing(Difference::Upwind)?;
        field.next(&moment, &sor(1.0), 1.0, 0)?;
        let domain = field.domain();
        let drift = drift_around_robots(domain, &moment.robots);
        let equation = Equation::LocallyOriented { drift, difference: Difference::Upwind };
        let Some(values) = eliminated(domain, &equation) else { continue };
        let is_led = domain.cell_at(at.map(|x| x.round() as i64)).is_some_and(|cell| 1.0 - values[cell] > LEVEL);
        let slope = ValueGuide::new(domain, &values, |place| domain.cell_at(place));
        let direction = direction(&slope, [1.0; 2], at).filter(|_| is_led);
        found.extend(direction.map(|direction| Exact { frame: k, at, direction }));
    }
    Ok(found)
}

/// Returns the angles, in degrees and ascending, between the directions of the blue team's seeker in its relaxed field and in its
/// exact field.
pub fn direction_errors(
    frames: &[Frame],
    exact: &[Exact],
    solver: &Solver,
    below: f64,
) -> Result<Vec<f64>, RelaxError> {
    let mut field = standing(Difference::Upwind)?;
    let mut angles = Vec::new();
    let mut sought = exact.iter().peekable();
    for (k, frame) in frames.iter().enumerate() {
        field.next(&Kind::Oriented.moment(frame), solver, below, MOST)?;
        if let Some(Exact { at, direction: b, .. }) = sought.next_if(|exact| exact.frame == k) {
            // A missing direction counts as the greatest error.
            let angle = |a: [f64; 2]| (a[0] * b[0] + a[1] * b[1]).clamp(-1.0, 1.0).acos().to_degrees();
            angles.push(field.direction(*at).map_or(180.0, angle));
        }
    }
    angles.sort_by(f64::total_cmp);
    Ok(angles)
}

/// Prints all measurements.
pub fn report(frames: &[Frame]) -> Result<(), RelaxError> {
    directions(frames)?;
    let seconds = frames.len() as f64 / RATE;
    println!(
        "{} frames, {seconds:.1} s of play; until the squared changes of a sweep add up to less than 1e-6;",
        frames.len()
    );
    let built = if cfg!(debug_assertions) {
        "a development build, several times slower than a release"
    } else {
        "a release build"
    };
    println!("times are means on one core, by {built}\n");
    println!("{HEAD}");
    let mut fastest = [f64::INFINITY; 2];
    for case in cases() {
        let by_multigrid = usize::from(case.solver == Solver::Multigrid);
        let row = Row::new(case, frames)?;
        fastest[by_multigrid] = fastest[by_multigrid].min(row.warm.milliseconds);
        println!("{row}");
    }
    let [relaxed, multigrid] = fastest.map(|milliseconds| 1e3 / milliseconds);
    println!("\nfields per second: {relaxed:.0} by relaxation, {multigrid:.0} by multigrid (required: 1000 and 5000)");
    println!(
        "\nCPLO at several query rates, while the camera takes 60 frames per second: share of fields that need one"
    );
    println!("sweep (published: over 80 %), mean sweeps, fields per second");
    for times in [1, 2, 5, 6, 10, 17] {
        print!("  {:>4} queries per second", (times as f64 * RATE).round());
        for (name, factor) in [("GS", 1.0), ("SOR 1.8", 1.8)] {
            let (kind, difference) = (Kind::LocallyOriented, Difference::Central);
            let run =
                run_after_every_frame(frames, times, &Case { kind, difference, solver: sor(factor), published: None })?;
            let rate = 1e3 / run.milliseconds;
            print!("   {name} {:>5.1} %, {:>6.2}, {rate:>5.0}", 100.0 * run.share_at_once(), run.mean_sweeps());
        }
        println!();
    }
    let [three, one] = three_and_one(frames)?;
    println!("\nthree CPO {three:.2} ms, one CPLO {one:.2} ms (published: 24.12 and 29.18)");
    Ok(())
}

/// Prints the deviations of directions of relaxed fields from exact ones.
fn directions(frames: &[Frame]) -> Result<(), RelaxError> {
    let exact = exact(frames)?;
    println!(
        "how far the blue seeker's direction is astray, degrees, where squared changes of a sweep add up to less than"
    );
    let tried = [
        ("1e-6, GS", sor(1.0), PUBLISHED_BELOW),
        ("1e-6, SOR 1.5", sor(1.5), PUBLISHED_BELOW),
        ("1e-6, multigrid", Solver::Multigrid, PUBLISHED_BELOW),
        ("1e-12, SOR 1.5", sor(1.5), 1e-12),
        ("1e-18, SOR 1.5", sor(1.5), 1e-18),
        ("1e-18, multigrid", Solver::Multigrid, 1e-18),
    ];
    for (name, solver, below) in tried {
        let angles = direction_errors(frames, &exact, &solver, below)?;
        let at = |part: f64| angles.get((part * angles.len() as f64) as usize).copied().unwrap_or(0.0);
        let wrong = angles.iter().filter(|&&angle| angle > 90.0).count();
        let (middle, most, all) = (at(0.5), at(0.95), angles.len());
        println!("  {name:<17} middle {middle:>7.3}, 95 % within {most:>7.3}; {wrong} of {all} away from the goal");
    }
    println!();
    Ok(())
}
