//! Links between documents, and snippets as readers see them.

use std::fs;
use std::path::{Component, Path, PathBuf};

use crate::{files, lines, root};

/// All documents: those at the root and in folders that have any.
fn documents() -> Vec<(String, String)> {
    let folders = ["docs", "peers", "examples", "benches", ".github"];
    let mut documents: Vec<_> = folders
        .iter()
        .flat_map(|folder| files(folder, "md"))
        .collect();
    for entry in fs::read_dir(root("")).expect("the root") {
        let path = entry.expect("a readable entry").path();
        if path.extension().is_some_and(|e| e == "md") {
            let name = path.file_name().expect("a file").to_string_lossy();
            let text = fs::read_to_string(&path).expect("a text file");
            documents.push((name.into_owned(), text));
        }
    }
    documents
}

/// The targets of links and pictures in a line.
fn targets(line: &str) -> impl Iterator<Item = &str> {
    let behind = line.split("](").skip(1);
    behind.filter_map(|rest| Some(rest.split_once(')')?.0))
}

/// The anchors of a document's headings, as GitHub makes them.
fn anchors(text: &str) -> Vec<String> {
    let headings = text.lines().filter(|line| line.starts_with('#'));
    let headings = headings.map(|line| line.trim_start_matches('#').trim().to_lowercase());
    let slug = |heading: String| {
        let kept = |c: &char| c.is_alphanumeric() || " -_".contains(*c);
        let kept: String = heading.chars().filter(kept).collect();
        kept.replace(' ', "-")
    };
    headings.map(slug).collect()
}

/// A path from the root on without `..`, unless it leaves the repository.
fn inside(path: &Path) -> Option<PathBuf> {
    let mut inside = PathBuf::new();
    for component in path.components() {
        match component {
            Component::ParentDir => inside.pop().then_some(())?,
            Component::Normal(name) => inside.push(name),
            _ => {}
        }
    }
    Some(inside)
}

/// Registries and forges resolve relative links against the repository, so what holds here holds there.
#[test]
fn links_lead_to_files_and_headings_of_this_repository() {
    let mut lost = Vec::new();
    let mut count = 0;
    for (document, text) in documents() {
        let folder = Path::new(&document).parent().expect("a folder");
        for (number, line) in lines(&text) {
            for target in targets(line).filter(|target| !target.contains("://")) {
                count += 1;
                let (path, anchor) = target.split_once('#').unwrap_or((target, ""));
                let path = match path {
                    "" => Some(PathBuf::from(&document)),
                    path => inside(&folder.join(path)),
                };
                let path = path.map(|path| root("").join(path));
                let path = path.filter(|path| path.exists());
                let leads = path.is_some_and(|path| {
                    let text = || fs::read_to_string(path).unwrap_or_default();
                    anchor.is_empty() || anchors(&text()).iter().any(|a| a == anchor)
                });
                if !leads {
                    lost.push(format!("{document}:{number}: {target}"));
                }
            }
        }
    }
    assert!(count > 50, "only {count} links were found");
    assert!(lost.is_empty(), "lead nowhere:\n{}", lost.join("\n"));
}

/// Most are in the package.
#[test]
fn every_picture_is_shown() {
    let documents = documents();
    let pictures = fs::read_dir(root("docs/pictures")).expect("a folder");
    for picture in pictures {
        let name = picture.expect("a readable entry").file_name();
        let name = format!("pictures/{}", name.to_string_lossy());
        let is_shown = documents.iter().any(|(_, text)| text.contains(&name));
        assert!(is_shown, "docs/{name}");
    }
}

/// For those who cannot see it, or whose reader does not load it.
#[test]
fn every_picture_is_also_put_into_words() {
    let mut silent = Vec::new();
    let mut count = 0;
    for (document, text) in documents() {
        for (number, line) in lines(&text) {
            for picture in line.split("![").skip(1) {
                count += 1;
                let words = picture.split(']').next().unwrap_or_default();
                if words.split(' ').count() < 4 {
                    silent.push(format!("{document}:{number}: {words}"));
                }
            }
        }
    }
    assert!(count > 15, "only {count} pictures were found");
    assert!(silent.is_empty(), "say too little:\n{}", silent.join("\n"));
}

/// Outside of rustdoc nothing hides the lines that begin with `# `: they would be copied, and not compile.
#[test]
fn snippets_have_no_hidden_lines() {
    let mut hidden = Vec::new();
    for (document, text) in documents() {
        let mut is_rust = false;
        for (number, line) in lines(&text) {
            if let Some(language) = line.trim_start().strip_prefix("```") {
                is_rust = language.starts_with("rust");
            } else if is_rust && (line == "#" || line.starts_with("# ")) {
                hidden.push(format!("{document}:{number}: {line}"));
            }
        }
    }
    assert!(hidden.is_empty(), "not hidden:\n{}", hidden.join("\n"));
}

/// It is a placeholder until the repository is public: nothing else may rely on it.
#[test]
fn the_address_of_the_repository_stands_in_one_place() {
    let manifest = fs::read_to_string(root("Cargo.toml")).expect("a manifest");
    let line = manifest
        .lines()
        .find_map(|line| line.strip_prefix("repository = "));
    let address = line.expect("an address").trim_matches('"');
    let others = ["src", "tests", "examples", "benches", "peers", "testkit"];
    let others = others
        .iter()
        .flat_map(|folder| [files(folder, "rs"), files(folder, "toml")].concat());
    let users = documents().into_iter().chain(others);
    let users = users.filter(|(_, text)| text.contains(address));
    let users: Vec<_> = users.map(|(path, _)| path).collect();
    assert!(users.is_empty(), "{address} also stands in {users:?}");
    assert_eq!(manifest.matches(address).count(), 1);
}
