//! A chapter: its explanation, its live figure, and its exercises with and without answers.

/// A chapter of the course, as Markdown.
#[derive(Debug, Clone, Copy)]
pub struct Chapter<'a> {
    /// Name of the file, without extension.
    pub name: &'a str,
    /// The whole text.
    pub text: &'a str,
    /// Subject of the chapter in one sentence, without markup.
    pub aim: &'a str,
}

/// The live figure of a chapter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Figure {
    /// Name of the page with its anchor: `proofs.html#learn=proofs`.
    pub address: String,
    /// The still picture that the figure replaces: `pictures/no_path.svg`.
    pub picture: String,
    /// Path of the robot.
    pub robot: String,
    /// Path of the world.
    pub world: String,
    /// Options of the planner.
    pub options: Vec<String>,
}

/// The comment that precedes the name of a live figure.
const LIVE: &str = "<!-- live: ";

/// Heading of the exercises.
const EXERCISES: &str = "\n## Exercises\n";

impl<'a> Chapter<'a> {
    /// Returns the title: the first heading.
    pub fn title(&self) -> &'a str {
        self.text.lines().find_map(|line| line.strip_prefix("# ")).unwrap_or(self.name)
    }

    /// Returns the path of the first picture. `None` if the text has only the picture that the live figure replaces, or none.
    pub fn first_picture(&self) -> Option<&'a str> {
        let live = self.figure().map(|figure| figure.picture);
        let mut targets =
            self.text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target);
        targets.find(|target| target.starts_with("pictures/") && Some(*target) != live.as_deref())
    }

    /// Returns the explanation: the text before the exercises, without the title.
    pub fn explanation(&self) -> &'a str {
        let before = self.text.split_once(EXERCISES).map_or(self.text, |(before, _)| before);
        before.split_once('\n').map_or("", |(_, rest)| rest)
    }

    /// Returns the exercises with their answers.
    pub fn answers(&self) -> &'a str {
        self.text.split_once(EXERCISES).map_or("", |(_, exercises)| exercises)
    }

    /// Returns the exercises without their answers.
    pub fn exercises(&self) -> String {
        let mut questions = String::new();
        let mut rest = self.answers();
        while let Some((before, after)) = rest.split_once("<details>") {
            questions += before;
            rest = after.split_once("</details>").map_or("", |(_, after)| after);
        }
        questions + rest
    }

    /// Returns the live figure. `None` if the chapter has no figure, or no command that creates it.
    pub fn figure(&self) -> Option<Figure> {
        let address = self.text.lines().find_map(|line| line.strip_prefix(LIVE)?.strip_suffix(" -->"))?;
        let page = address.split('#').next()?;
        let before = self.text.split_once(LIVE)?.0.trim_end();
        let picture = before.strip_suffix(')')?.rsplit_once("](")?.1.to_owned();
        let is_command = |line: &&str| line.starts_with("cplan ") && line.ends_with(&format!(" --picture {page}"));
        let command = self.text.lines().find(is_command)?;
        let words: Vec<&str> = command.strip_suffix(page)?.strip_suffix(" --picture ")?.split_whitespace().collect();
        let [_, robot, world, options @ ..] = words.as_slice() else { return None };
        let options = options.iter().filter(|word| **word != "--quiet").map(|word| (*word).to_owned()).collect();
        let [address, robot, world] = [address, *robot, *world].map(str::to_owned);
        Some(Figure { address, picture, robot, world, options })
    }
}

impl Figure {
    /// Returns the name of the page.
    pub fn page(&self) -> &str {
        self.address.split('#').next().unwrap_or_default()
    }
}
