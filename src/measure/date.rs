//! The date of a measurement.

use std::time::{SystemTime, UNIX_EPOCH};

/// Now, as ISO 8601 in UTC to the second.
pub fn now() -> String {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    of_unix_seconds(since.as_secs())
}

fn of_unix_seconds(seconds: u64) -> String {
    let (mut days, second) = (seconds / 86_400, seconds % 86_400);
    let is_leap = |year: u64| year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    let mut year = 1970;
    while days >= 365 + u64::from(is_leap(year)) {
        days -= 365 + u64::from(is_leap(year));
        year += 1;
    }
    let lengths = [31, 28 + u64::from(is_leap(year)), 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    let mut month = 1;
    for length in lengths {
        if days < length {
            break;
        }
        days -= length;
        month += 1;
    }
    let (hour, minute) = (second / 3600, second / 60 % 60);
    format!("{year:04}-{month:02}-{:02}T{hour:02}:{minute:02}:{:02}Z", days + 1, second % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_months_and_leap_years_are_counted() {
        assert_eq!(of_unix_seconds(0), "1970-01-01T00:00:00Z");
        assert_eq!(of_unix_seconds(951_782_399), "2000-02-28T23:59:59Z");
        assert_eq!(of_unix_seconds(951_782_400), "2000-02-29T00:00:00Z");
        assert_eq!(of_unix_seconds(1_735_689_599), "2024-12-31T23:59:59Z");
    }
}
