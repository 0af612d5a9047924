//! Runs an experiment: a first round with pictures, truths and metrics, then rounds of time alone, all cases in turn.

use std::ops::ControlFlow;
use std::rc::Rc;
use std::time::{Duration, Instant};

use super::date;
use super::experiment::{Case, ChartKind, Entry, Experiment, Figure, GoOn, MeasureError, Setup};
use super::metrics::{self, Metrics, Options};
use crate::scene::Image;

/// Milliseconds of each pass of a frame, by its name.
pub type PassTimes = Vec<(&'static str, f64)>;

/// Rounds of an ordinary run.
const ROUNDS: usize = 5;
/// Rounds of a thorough one.
const ROUNDS_THOROUGH: usize = 15;
/// What an ordinary run may take; a round that has begun when it is spent is finished.
const BUDGET: Duration = Duration::from_secs(165);

/// One method with its settings on one scene, measured.
#[derive(Debug, Clone)]
pub struct Row {
    /// What it stands for.
    pub entry: Entry,
    /// Milliseconds of a frame in each round.
    pub frame_ms: Vec<f64>,
    /// Milliseconds of each pass of a frame, of the rounds that timed them: the first, or all.
    pub pass_rounds: Vec<PassTimes>,
    /// Bytes of objects and targets on the device.
    pub bytes: u64,
    /// How far the picture is from the truth; none where there is no truth, or it was not reached.
    pub error: Option<Metrics>,
    /// What else the picture shows beside the truth.
    pub figures: Vec<Figure>,
    /// The picture, where there is a truth.
    pub picture: Option<Rc<Image>>,
    /// What it should look like.
    pub truth: Option<Rc<Image>>,
    /// FLIP of each pixel.
    pub difference: Option<Rc<Image>>,
}

impl Row {
    fn new(case: &Case) -> Row {
        Row {
            entry: case.entry.clone(),
            frame_ms: Vec::new(),
            pass_rounds: Vec::new(),
            bytes: 0,
            error: None,
            figures: Vec::new(),
            picture: None,
            truth: None,
            difference: None,
        }
    }

    /// A figure by its name.
    pub fn figure(&self, name: &str) -> Option<f64> {
        self.figures.iter().find(|(known, _)| *known == name).map(|(_, value)| *value)
    }

    /// Milliseconds of each pass of a frame of which this share of the rounds took less; 0.5 for the median.
    pub fn pass_ms(&self, share: f64) -> PassTimes {
        let first = self.pass_rounds.first().map_or(&[][..], Vec::as_slice);
        let of = |name: &'static str| {
            let rounds = self.pass_rounds.iter().flatten().filter(|(known, _)| *known == name);
            (name, quantile(&rounds.map(|(_, ms)| *ms).collect::<Vec<_>>(), share))
        };
        first.iter().map(|(name, _)| of(name)).collect()
    }

    /// Median milliseconds of a frame.
    pub fn median_ms(&self) -> f64 {
        quantile(&self.frame_ms, 0.5)
    }

    /// Median nanoseconds of a pixel of a frame.
    pub fn median_ns_per_pixel(&self) -> f64 {
        let pixels = f64::from(self.entry.size[0]) * f64::from(self.entry.size[1]);
        self.median_ms() * 1e6 / pixels
    }
}

/// What came of an experiment.
#[derive(Debug, Clone)]
pub struct Report {
    /// Its name.
    pub name: &'static str,
    /// What it finds out.
    pub doc: &'static str,
    /// What its chart shows.
    pub chart: ChartKind,
    /// How the numbers come about.
    pub conditions: Vec<String>,
    /// What the chart says.
    pub says: String,
    /// What the rows come to.
    pub findings: Vec<String>,
    /// The adapter; none where nothing was drawn by one.
    pub adapter: Option<String>,
    /// Its driver.
    pub driver: Option<String>,
    /// When it began: ISO 8601, UTC.
    pub date: String,
    /// Rounds that were finished.
    pub rounds: usize,
    /// Rounds that were due.
    pub rounds_due: usize,
    /// It was broken off before all was measured.
    pub is_partial: bool,
    /// What all of it took, in seconds.
    pub seconds: f64,
    /// The rows, scene by scene.
    pub rows: Vec<Row>,
}

impl Report {
    /// How much longer the slowest round took than the fastest, as a share of the fastest; none of a single round.
    pub fn noise(&self) -> Option<f64> {
        let totals: Vec<f64> = (0..self.rounds)
            .map(|round| self.rows.iter().filter_map(|row| row.frame_ms.get(round)).sum())
            .filter(|total| *total > 0.0)
            .collect();
        let (min, max) = (quantile(&totals, 0.0), quantile(&totals, 1.0));
        (totals.len() > 1).then(|| max / min - 1.0)
    }

    /// Sizes of pictures, each once.
    pub fn sizes(&self) -> Vec<[u32; 2]> {
        let mut sizes: Vec<[u32; 2]> = self.rows.iter().map(|row| row.entry.size).collect();
        sizes.sort_unstable();
        sizes.dedup();
        sizes
    }
}

/// A value of which this share of all values is smaller; 0.5 is the median. Between two values it is their mix.
pub fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let at = share.clamp(0.0, 1.0) * last as f64;
    let (below, above) = (sorted[at.floor() as usize], sorted[at.ceil() as usize]);
    below + (above - below) * at.fract()
}

/// The geometric mean; NaN of nothing.
pub fn geometric_mean(values: impl IntoIterator<Item = f64>) -> f64 {
    let (sum, count) = values.into_iter().fold((0.0, 0usize), |(sum, count), value| (sum + value.ln(), count + 1));
    (sum / count as f64).exp()
}

/// How many rounds there are, and until when one may begin.
#[derive(Debug, Clone, Copy)]
struct Plan {
    rounds: usize,
    /// Rounds that are due even where the time is spent.
    least: usize,
    end: Option<Instant>,
    /// Whether every round times the passes.
    times_passes: bool,
}

impl Plan {
    fn new(thorough: bool, start: Instant) -> Plan {
        let (rounds, end) = match thorough {
            true => (ROUNDS_THOROUGH, None),
            false => (ROUNDS, Some(start + BUDGET)),
        };
        Plan { rounds, least: 0, end, times_passes: false }
    }

    fn of(experiment: &dyn Experiment, thorough: bool, start: Instant) -> Plan {
        let (plan, least) = (Plan::new(thorough, start), experiment.least_rounds());
        Plan { rounds: plan.rounds.max(least), least, times_passes: experiment.times_passes(), ..plan }
    }

    /// Whether another round begins after so many, the last of which took `last`.
    fn goes_on(&self, done: usize, now: Instant, last: Duration) -> bool {
        done < self.rounds && (done < self.least || self.end.is_none_or(|end| now + last <= end))
    }
}

/// Runs an experiment. `progress` hears how much is done of how much; `go_on` may break it off: what was measured until
/// then is kept and marked as partial.
///
/// # Errors
/// [`MeasureError`], but not of an interruption.
pub fn run(
    experiment: &dyn Experiment,
    setup: &Setup,
    progress: &mut dyn FnMut(u64, u64),
    go_on: GoOn<'_>,
) -> Result<Report, MeasureError> {
    let (start, date) = (Instant::now(), date::now());
    let plan = Plan::of(experiment, setup.thorough, start);
    let mut cases = experiment.cases(setup)?;
    let mut rows: Vec<Row> = cases.iter().map(Row::new).collect();
    let total = (cases.len() * (plan.rounds + 1)) as u64;
    let info = setup.gpu.as_ref().filter(|_| experiment.needs_gpu()).map(|gpu| &gpu.info);
    let mut done = 0;
    let mut rounds = 0;
    let mut step = || {
        done += 1;
        progress(done, total);
    };
    let result = measure(&mut cases, &mut rows, &plan, &mut rounds, &mut step, go_on);
    let is_partial = match result {
        Ok(()) => false,
        Err(MeasureError::Interrupted) => true,
        Err(error) => return Err(error),
    };
    rows.retain(|row| !row.frame_ms.is_empty());
    Ok(Report {
        name: experiment.name(),
        doc: experiment.doc(),
        chart: experiment.chart(),
        conditions: experiment.conditions(setup),
        says: experiment.says(&rows),
        findings: experiment.findings(&rows),
        adapter: info.map(|info| info.name.clone()),
        driver: info.map(|info| format!("{} {}", info.driver, info.driver_info).trim().to_owned()),
        date,
        rounds,
        rounds_due: plan.rounds,
        is_partial,
        seconds: start.elapsed().as_secs_f64(),
        rows,
    })
}

fn measure(
    cases: &mut [Case],
    rows: &mut [Row],
    plan: &Plan,
    rounds: &mut usize,
    step: &mut dyn FnMut(),
    go_on: GoOn<'_>,
) -> Result<(), MeasureError> {
    let check = || if go_on() == ControlFlow::Continue(()) { Ok(()) } else { Err(MeasureError::Interrupted) };
    let mut last = Duration::ZERO;
    while plan.goes_on(*rounds, Instant::now(), last) {
        let round = Instant::now();
        for (case, row) in cases.iter_mut().zip(rows.iter_mut()) {
            check()?;
            row.frame_ms.push(case.subject.frame_ms()?);
            if *rounds == 0 || plan.times_passes {
                row.pass_rounds.push(case.subject.pass_ms()?);
            }
            if *rounds == 0 {
                row.bytes = case.subject.bytes();
                if case.truth.is_some() {
                    row.picture = Some(Rc::new(case.subject.picture()?));
                }
            }
            step();
        }
        *rounds += 1;
        last = round.elapsed();
        if *rounds == 1 {
            // The first also builds, and draws what later ones need not: they take about half of it.
            last /= 2;
            judge(cases, rows, step, go_on)?;
        }
    }
    Ok(())
}

/// Holds the pictures against their truths.
fn judge(cases: &[Case], rows: &mut [Row], step: &mut dyn FnMut(), go_on: GoOn<'_>) -> Result<(), MeasureError> {
    for (case, row) in cases.iter().zip(rows) {
        if let (Some(truth), Some(picture)) = (&case.truth, &row.picture) {
            let truth = truth.image(go_on)?;
            // Both are drawn in one size.
            if let Ok(comparison) = metrics::compare(&truth, picture, &Options::default()) {
                row.error = Some(comparison.metrics);
                row.difference = Some(Rc::new(comparison.flip_image()));
            }
            row.figures = case.judge.as_ref().map_or_else(Vec::new, |judge| judge(&truth, picture));
            row.truth = Some(truth);
        }
        step();
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_lie_between_values() {
        let values = [4.0, 1.0, 3.0, 2.0];
        assert_eq!([0.0, 0.5, 1.0].map(|share| quantile(&values, share)), [1.0, 2.5, 4.0]);
        assert_eq!(quantile(&[7.0], 0.5), 7.0);
        assert!(quantile(&[], 0.5).is_nan());
    }

    #[test]
    fn rounds_end_by_number_and_by_time() {
        let start = Instant::now();
        let plan = Plan::new(false, start);
        let second = Duration::from_secs(1);
        assert!(plan.goes_on(0, start, Duration::ZERO) && plan.goes_on(ROUNDS - 1, start, second));
        assert!(!plan.goes_on(ROUNDS, start, second));
        // A round that would not end in time does not begin.
        assert!(!plan.goes_on(1, start + BUDGET - second, 2 * second));
        let patient = Plan { least: 3, ..plan };
        assert!(patient.goes_on(2, start + 2 * BUDGET, second) && !patient.goes_on(3, start + 2 * BUDGET, second));
        let thorough = Plan::new(true, start);
        assert!(thorough.goes_on(ROUNDS_THOROUGH - 1, start + 100 * BUDGET, BUDGET));
    }
}
