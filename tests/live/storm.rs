//! A storm of saves: nothing breaks, no broken style is shown, the last save wins, and nothing leaks.

use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use restyle::engine::Reload;

use super::rig::{Live, PATIENCE, ground, parses};

/// Saves in a storm: 1,000 in 20 seconds by `RESTYLE_STORM=1000`, some hundred in a run of all tests.
fn saves() -> usize {
    std::env::var("RESTYLE_STORM").ok().and_then(|count| count.parse().ok()).unwrap_or(200)
}

/// Time between two saves.
const BETWEEN: Duration = Duration::from_millis(20);

/// Every tenth save is broken, each in a way of its own.
fn text(save: usize) -> String {
    let good = ground(color(save));
    match save % 40 {
        9 => good[..good.len() / 2].to_owned(),
        19 => good.replace("bgcolor", "bgcolour"),
        29 => good.replace("[", "[300, "),
        39 => String::new(),
        _ => good,
    }
}

/// Another colour for each save.
fn color(save: usize) -> [u8; 3] {
    [(save % 256) as u8, (save / 256) as u8, 77]
}

fn save(path: &Path, number: usize) {
    let text = text(number);
    match number % 3 {
        // In place: cut to nothing, then written.
        0 => {
            let mut file = File::create(path).unwrap();
            if number.is_multiple_of(2) {
                std::thread::sleep(Duration::from_millis(2));
            }
            file.write_all(text.as_bytes()).unwrap();
        }
        // By rename.
        1 => {
            let beside = path.with_extension("new");
            fs::write(&beside, &text).unwrap();
            fs::rename(&beside, path).unwrap();
        }
        // In place over the old bytes, then cut to length.
        _ => {
            let mut file = File::options().write(true).create(true).truncate(false).open(path).unwrap();
            file.write_all(text.as_bytes()).unwrap();
            file.set_len(text.len() as u64).unwrap();
        }
    }
}

/// Open handles and resident memory in KiB, where the system tells.
fn usage() -> Option<(usize, u64)> {
    let handles = fs::read_dir("/proc/self/fd").ok()?.count();
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    Some((handles, line.trim().trim_end_matches("kB").trim().parse().ok()?))
}

#[test]
fn a_storm_of_saves_ends_with_the_last_one_shown() {
    let saves = saves();
    let files = [("s.json", ground([1, 2, 3])), ("m.xyz", "1\n\nC 0 0 0\n".to_owned())];
    let Some(mut live) = Live::new("storm", &files.each_ref().map(|(name, text)| (*name, text.as_str()))) else {
        return;
    };
    live.taken();
    let path = live.path("s.json");
    let done = AtomicBool::new(false);
    let (mut frames, mut refusals) = (0, 0);
    let mut early = None;
    std::thread::scope(|scope| {
        scope.spawn(|| {
            let start = Instant::now();
            for number in 0..saves {
                save(&path, number);
                let next = BETWEEN * (number as u32 + 1);
                std::thread::sleep(next.saturating_sub(start.elapsed()));
            }
            // The last one is good.
            save(&path, saves.next_multiple_of(40) + 1);
            done.store(true, Ordering::Relaxed);
        });
        while !done.load(Ordering::Relaxed) {
            for reload in live.engine.wait(Duration::from_millis(20)) {
                match reload {
                    Reload::Taken(..) => {
                        frames += 1;
                        let [red, green, blue] = live.ground();
                        let number = usize::from(green) * 256 + usize::from(red);
                        assert!(
                            blue == 77 && parses(&text(number)),
                            "a picture of no good style: {red} {green} {blue}"
                        );
                    }
                    Reload::Refused(..) => refusals += 1,
                    Reload::Mended(..) => {}
                }
            }
            if frames == saves / 4 && early.is_none() {
                early = usage();
            }
        }
    });
    let last = color(saves.next_multiple_of(40) + 1);
    let start = Instant::now();
    while live.ground() != last {
        assert!(start.elapsed() < PATIENCE, "the last save is not shown: {:?}", live.ground());
        live.engine.wait(Duration::from_millis(100));
    }
    assert!(frames > saves / 4, "{frames} frames of {saves} saves");
    println!("{saves} saves: {frames} frames, {refusals} refusals told, usage early {early:?}, late {:?}", usage());
    if let (Some((handles, kib)), Some((late_handles, late_kib))) = (early, usage()) {
        // Other tests of this process open files of their own meanwhile.
        assert!(late_handles <= handles + 64, "{handles} handles, then {late_handles}");
        assert!(late_kib < kib + (32 << 10), "{kib} KiB, then {late_kib}");
    }
}
