//! Formats date and time.

use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Returns the current time, such as `2026-11-21 14:03:53 UTC`.
pub fn current_time() -> String {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or(Duration::ZERO);
    written(since.as_secs())
}

/// Formats a time in seconds since the beginning of 1970. Howard Hinnant's `civil_from_days` converts days to dates. It
/// counts eras of 400 years that begin in March, so that leap days come last.
fn written(seconds: u64) -> String {
    let (days, second) = (seconds / 86_400 + 719_468, seconds % 86_400);
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    let year = era * 400 + year_of_era + u64::from(month <= 2);
    let (hour, minute) = (second / 3600, second / 60 % 60);
    format!("{year:04}-{month:02}-{day:02} {hour:02}:{minute:02}:{:02} UTC", second % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_times_are_written() {
        assert_eq!(written(0), "1970-01-01 00:00:00 UTC");
        assert_eq!(written(951_782_399), "2000-02-28 23:59:59 UTC");
        assert_eq!(written(951_782_400), "2000-02-29 00:00:00 UTC");
        assert_eq!(written(1_000_000_000), "2001-09-09 01:46:40 UTC");
        assert_eq!(written(4_107_542_400), "2100-03-01 00:00:00 UTC");
    }

    /// Tests that dates agree with a simple calendar, day by day for two centuries.
    #[test]
    fn every_day_of_two_centuries_agrees_with_a_simple_calendar() {
        let (mut year, mut month, mut day) = (1970, 1, 1);
        for days in 0..73_000_u64 {
            assert_eq!(written(days * 86_400), format!("{year:04}-{month:02}-{day:02} 00:00:00 UTC"));
            let is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
            let length = match month {
                2 => 28 + i32::from(is_leap),
                4 | 6 | 9 | 11 => 30,
                _ => 31,
            };
            day += 1;
            if day > length {
                (day, month) = (1, month + 1);
            }
            if month > 12 {
                (month, year) = (1, year + 1);
            }
        }
    }
}
