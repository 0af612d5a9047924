//! What was asked of the device so far: how a test, and anyone who wonders, sees that a change costs only what it needs.

use std::ops::Sub;
use std::sync::atomic::{AtomicU64, Ordering};

/// Work that was asked of a device. The difference of two is what happened between them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counters {
    /// Pipelines compiled.
    pub pipelines_built: u64,
    /// Buffers created.
    pub buffers_created: u64,
    /// Textures created.
    pub textures_created: u64,
    /// Bind groups created.
    pub bind_groups_created: u64,
    /// Writes to buffers and textures.
    pub writes: u64,
    /// Bytes that those writes carried.
    pub bytes_written: u64,
}

impl Sub for Counters {
    type Output = Counters;

    fn sub(self, earlier: Counters) -> Counters {
        Counters {
            pipelines_built: self.pipelines_built - earlier.pipelines_built,
            buffers_created: self.buffers_created - earlier.buffers_created,
            textures_created: self.textures_created - earlier.textures_created,
            bind_groups_created: self.bind_groups_created - earlier.bind_groups_created,
            writes: self.writes - earlier.writes,
            bytes_written: self.bytes_written - earlier.bytes_written,
        }
    }
}

/// The counters of an open device.
#[derive(Debug, Default)]
pub(super) struct Counting {
    pub(super) pipelines: AtomicU64,
    pub(super) buffers: AtomicU64,
    pub(super) textures: AtomicU64,
    pub(super) bind_groups: AtomicU64,
    writes: AtomicU64,
    bytes: AtomicU64,
}

impl Counting {
    /// Counts one of a kind.
    pub(super) fn one(counter: &AtomicU64) {
        counter.fetch_add(1, Ordering::Relaxed);
    }

    /// Counts one write.
    pub(super) fn write(&self, bytes: usize) {
        self.writes.fetch_add(1, Ordering::Relaxed);
        self.bytes.fetch_add(bytes as u64, Ordering::Relaxed);
    }

    /// The counters as they stand.
    pub(super) fn read(&self) -> Counters {
        let of = |counter: &AtomicU64| counter.load(Ordering::Relaxed);
        Counters {
            pipelines_built: of(&self.pipelines),
            buffers_created: of(&self.buffers),
            textures_created: of(&self.textures),
            bind_groups_created: of(&self.bind_groups),
            writes: of(&self.writes),
            bytes_written: of(&self.bytes),
        }
    }
}
