//! When a file that something wrote to is read: as soon as it is whole, and not before.
//!
//! Editors write in place, by renaming a new file over the old one, or by truncating first. A closed writer or a rename
//! says that the file is whole; elsewhere a short silence must do. What is wrong while it is being written is told only
//! when it has stayed wrong for longer.

use std::time::{Duration, Instant};

/// Silence after which a file counts as written where nothing says so. Ours: an editor's writes lie below a millisecond
/// apart, and a designer does not feel it.
pub const QUIET: Duration = Duration::from_millis(10);

/// Longest time that unceasing writes hold a reload up.
pub const LONGEST_HELD: Duration = Duration::from_millis(40);

/// How long a file must stay wrong before that is told. Ours: a truncated or missing file is mostly half of a save.
pub const GRACE: Duration = Duration::from_millis(200);

/// What happened to a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Touch {
    /// Something was written or went away; more may follow.
    Written,
    /// A writer has closed it, or it came in place as a whole.
    Settled,
}

/// Changes of one part that have not been read yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Pending {
    first: Option<Instant>,
    last: Option<Instant>,
    settled: bool,
    /// When what was wrong is read once more before it is told.
    recheck: Option<Instant>,
}

impl Pending {
    /// Something happened.
    pub fn touch(&mut self, touch: Touch, now: Instant) {
        self.first.get_or_insert(now);
        self.last = Some(now);
        self.settled = touch == Touch::Settled;
    }

    /// When the part is to be read; none: there is nothing to read.
    pub fn due_at(&self) -> Option<Instant> {
        let written = self
            .first
            .zip(self.last)
            .map(|(first, last)| if self.settled { first } else { (last + QUIET).min(first + LONGEST_HELD) });
        match (written, self.recheck) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        }
    }

    /// Whether this reading is the second look at something wrong, which is now told.
    pub fn is_recheck(&self, now: Instant) -> bool {
        self.recheck.is_some_and(|at| at <= now)
    }

    /// When the first change was noticed that is being read now.
    pub fn noticed(&self) -> Option<Instant> {
        self.first
    }

    /// It is being read now.
    pub fn read(&mut self) {
        (self.first, self.last, self.settled) = (None, None, false);
    }

    /// What was read is wrong: look again when the grace is over.
    pub fn wrong(&mut self, now: Instant) {
        self.recheck = Some(now + GRACE);
    }

    /// Nothing is waiting to be told.
    pub fn resolved(&mut self) {
        self.recheck = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_closed_file_is_read_at_once_and_an_open_one_after_silence() {
        let start = Instant::now();
        let mut pending = Pending::default();
        assert_eq!(pending.due_at(), None);
        pending.touch(Touch::Written, start);
        assert_eq!(pending.due_at(), Some(start + QUIET));
        pending.touch(Touch::Settled, start + Duration::from_millis(1));
        assert!(pending.due_at() <= Some(start + Duration::from_millis(1)));
        pending.read();
        assert_eq!(pending.due_at(), None);
    }

    #[test]
    fn unceasing_writes_do_not_hold_it_up_for_ever() {
        let start = Instant::now();
        let mut pending = Pending::default();
        for ms in 0..1000 {
            pending.touch(Touch::Written, start + Duration::from_millis(ms));
        }
        assert_eq!(pending.due_at(), Some(start + LONGEST_HELD));
    }

    #[test]
    fn what_is_wrong_is_looked_at_again() {
        let start = Instant::now();
        let mut pending = Pending::default();
        pending.touch(Touch::Settled, start);
        pending.read();
        pending.wrong(start);
        assert_eq!(pending.due_at(), Some(start + GRACE));
        assert!(!pending.is_recheck(start) && pending.is_recheck(start + GRACE));
        pending.resolved();
        assert_eq!(pending.due_at(), None);
    }
}
