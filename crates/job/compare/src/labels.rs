//! Short names of planners, for charts and legends without room for all options.

/// Shortens the names of rows (planners with their options), but keeps them distinct. Omits an option that occurs in all rows of
/// a planner, if these rows also have other options. A name stays unchanged if the short forms of two rows would be equal.
pub fn labels(names: &[&str]) -> Vec<String> {
    let parts: Vec<(&str, Vec<String>)> = names.iter().map(|name| options(name)).collect();
    let short = |(planner, options): &(&str, Vec<String>)| {
        let alike = || parts.iter().filter(|(other, theirs)| other == planner && !theirs.is_empty());
        let is_common = |option: &String| alike().count() > 1 && alike().all(|(_, theirs)| theirs.contains(option));
        let kept = options.iter().filter(|option| !is_common(option));
        kept.fold((*planner).to_owned(), |name, option| format!("{name} {option}"))
    };
    let shorts: Vec<String> = parts.iter().map(short).collect();
    let is_taken = |short: &String| shorts.iter().filter(|other| *other == short).count() > 1;
    names
        .iter()
        .zip(&shorts)
        .map(|(name, short)| if is_taken(short) { (*name).to_owned() } else { short.clone() })
        .collect()
}

/// Splits a name into the planner and its options with their values.
fn options(name: &str) -> (&str, Vec<String>) {
    let mut words = name.split_whitespace();
    let planner = words.next().unwrap_or(name);
    let mut options: Vec<String> = Vec::new();
    for word in words {
        match options.last_mut() {
            Some(option) if !word.starts_with("--") => *option += &format!(" {word}"),
            _ => options.push(word.to_owned()),
        }
    }
    (planner, options)
}

#[cfg(test)]
mod tests {
    use super::labels;

    #[test]
    fn shared_options_are_omitted_from_labels() {
        let names = [
            "shortest",
            "harmonic",
            "harmonic --field oriented --epsilon 0.5 --direction 0,-1",
            "harmonic --field oriented --epsilon 1 --direction 0,-1",
            "wavefront --search astar",
        ];
        let short =
            ["shortest", "harmonic", "harmonic --epsilon 0.5", "harmonic --epsilon 1", "wavefront --search astar"];
        assert_eq!(labels(&names), short);
    }

    #[test]
    fn no_two_rows_get_one_name() {
        // Without the options that both other rows have, the second row would have the first row's name.
        let names = ["prm", "prm --seed 1", "prm --seed 1 --nearest 4"];
        assert_eq!(labels(&names), ["prm", "prm --seed 1", "prm --nearest 4"]);
        assert_eq!(labels(&["prm --seed 1", "prm --seed 1"]), ["prm --seed 1"; 2]);
        assert_eq!(labels(&[]), Vec::<String>::new());
    }
}
