//! Markdown as HTML, with the links of the course.

use crate::chapter::Figure;
use cplan_text::markup;
use pulldown_cmark::{CowStr, Event, HeadingLevel, LinkType, Options, Parser, Tag, TagEnd, html};

/// The destinations of the links of a text.
pub struct Links<'a> {
    /// Names of the chapters, without extension.
    pub chapters: &'a [&'a str],
    /// Path from the page to the folder of the course: empty or `../`.
    pub root: &'a str,
    /// The live figure, which replaces its picture. `None` if the text has none.
    pub figure: Option<&'a Figure>,
}

impl Links<'_> {
    /// Converts a text. Links to pages outside the course become plain text, and comments are dropped.
    pub fn html(&self, text: &str) -> String {
        let mut converted = Vec::new();
        // Open links that are dropped, and the alternative text of the picture that the figure replaces.
        let (mut dropped_links, mut alternative): (usize, Option<String>) = (0, None);
        for event in Parser::new_ext(text, Options::ENABLE_TABLES) {
            if let Some(words) = &mut alternative {
                match event {
                    Event::Text(text) | Event::Code(text) => *words += &text,
                    Event::SoftBreak => words.push(' '),
                    Event::End(TagEnd::Image) => {
                        let frame = self.figure.map(|figure| self.frame(&figure.address, words));
                        converted.extend(frame.map(|frame| Event::InlineHtml(frame.into())));
                        alternative = None;
                    }
                    _ => (),
                }
                continue;
            }
            match event {
                Event::Start(Tag::Image { dest_url, .. })
                    if self.figure.is_some_and(|figure| figure.picture == *dest_url) =>
                {
                    alternative = Some(String::new());
                }
                Event::Start(Tag::Image { link_type, dest_url, title, id }) => {
                    let dest_url = format!("{}{dest_url}", self.root).into();
                    converted.push(Event::Start(Tag::Image { link_type, dest_url, title, id }));
                }
                Event::Start(Tag::Link { dest_url, .. }) => match self.target(&dest_url) {
                    Some(target) => converted.push(link(target)),
                    None => dropped_links += 1,
                },
                Event::End(TagEnd::Link) if dropped_links > 0 => dropped_links -= 1,
                Event::Start(Tag::Heading { level, .. }) => converted.push(heading(level)),
                Event::Html(text) | Event::InlineHtml(text) if text.trim_start().starts_with("<!--") => (),
                other => converted.push(other),
            }
        }
        let mut page = String::new();
        html::push_html(&mut page, converted.into_iter());
        page
    }

    /// Returns the address of a link within the course or to the internet. `None` for pages outside the course.
    fn target(&self, link: &str) -> Option<String> {
        if link.starts_with("https://") || link.starts_with('#') {
            return Some(link.to_owned());
        }
        let (page, anchor) = link.split_once('#').map_or((link, ""), |(page, anchor)| (page, anchor));
        let chapter = page.strip_suffix(".md").filter(|name| self.chapters.contains(name))?;
        let anchor = if anchor.is_empty() { String::new() } else { format!("#{anchor}") };
        Some(format!("{}{chapter}.html{anchor}", self.root))
    }

    /// Returns the frame of the live figure.
    fn frame(&self, address: &str, words: &str) -> String {
        format!(r#"<iframe src="{}live/{}" title="{}"></iframe>"#, self.root, markup(address), markup(words))
    }
}

fn link(target: String) -> Event<'static> {
    let (dest_url, nothing) = (target.into(), CowStr::Borrowed(""));
    Event::Start(Tag::Link { link_type: LinkType::Inline, dest_url, title: nothing.clone(), id: nothing })
}

fn heading(level: HeadingLevel) -> Event<'static> {
    Event::Start(Tag::Heading { level, id: None, classes: Vec::new(), attrs: Vec::new() })
}
