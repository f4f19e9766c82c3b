//! Every link leads to an existing file, and to a heading in it.

use super::page::Page;
use super::{pages, root};

#[test]
fn every_link_leads_somewhere() {
    let others = ["CONTRIBUTING.md", "SECURITY.md", "CHANGELOG.md", "fuzz/README.md", "benches/peers/README.md"];
    let mut all = pages();
    all.extend(others.iter().map(|file| Page::read(&root().join(file))));
    let (mut wrong, mut followed) = (Vec::new(), 0);
    for page in &all {
        for link in page.links() {
            if ["https://", "http://"].iter().any(|scheme| link.target.starts_with(scheme)) {
                continue;
            }
            followed += 1;
            let (path, anchor) = link.target.split_once('#').unwrap_or((&link.target, ""));
            let target = if path.is_empty() { page.file.clone() } else { page.file.parent().unwrap().join(path) };
            let leads =
                target.exists() && (anchor.is_empty() || Page::read(&target).anchors().iter().any(|a| a == anchor));
            if !leads {
                wrong.push(format!("{}:{}: {}", page.name, link.line, link.target));
            }
        }
    }
    assert!(wrong.is_empty(), "links to nowhere:\n{}", wrong.join("\n"));
    assert!(followed > 80, "only {followed} links");
}
