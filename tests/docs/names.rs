//! Names of files, targets and tests.

use std::fs;

use crate::{files, lines, root};

/// Folders whose files documents name by their path from the root.
const FOLDERS: [&str; 7] = [
    "src/",
    "tests/",
    "benches/",
    "examples/",
    "docs/",
    "testkit/",
    ".ci/",
];

/// The documents at the root and in `docs`.
fn documents() -> Vec<(String, String)> {
    let at_root = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"].map(file);
    at_root.into_iter().chain(files("docs", "md")).collect()
}

fn file(path: &str) -> (String, String) {
    let text = fs::read_to_string(root(path)).expect("a text file");
    (path.to_owned(), text)
}

/// Each word between backticks or quotation marks that looks like a file.
fn paths(line: &str) -> impl Iterator<Item = &str> {
    let is_path = |word: &&str| {
        let plain = |c: char| c.is_ascii_alphanumeric() || "/._-".contains(c);
        let is_named = FOLDERS.iter().any(|folder| word.starts_with(folder));
        word.chars().all(plain) && (is_named || word.ends_with(".rs")) && !word.ends_with("/make")
    };
    line.split(['`', '"', '(', ')', ' ']).filter(is_path)
}

#[test]
fn files_that_documents_name_exist() {
    let modules = [files("src", "rs"), files("tests", "rs")].concat();
    let mut lost = Vec::new();
    for (document, text) in documents() {
        for (number, line) in lines(&text) {
            for path in paths(line) {
                // A name alone is that of a file in the module at hand.
                let is_known = match path.contains('/') {
                    true => [path, &format!("src/{path}")]
                        .iter()
                        .any(|p| root(p).exists()),
                    false => modules
                        .iter()
                        .any(|(p, _)| p.ends_with(&format!("/{path}"))),
                };
                if !is_known {
                    lost.push(format!("{document}:{number}: {path}"));
                }
            }
        }
    }
    assert!(lost.is_empty(), "no such files:\n{}", lost.join("\n"));
}

#[test]
fn targets_of_commands_exist() {
    let mut texts = documents();
    texts.extend([".ci/run", "benches/results/make"].map(file));
    let mut lost = Vec::new();
    for (document, text) in texts {
        for (number, line) in lines(&text) {
            let words: Vec<_> = line.split(['`', ' ']).collect();
            for pair in words.windows(2) {
                let name = pair[1].trim_end_matches(['.', ',', ':']);
                let places = match pair[0] {
                    "--test" => vec![format!("tests/{name}/main.rs")],
                    "--example" => vec![format!("examples/{name}.rs")],
                    "--bench" => ["", "criterion/benches/"]
                        .iter()
                        .flat_map(|folder| {
                            [".rs", "/main.rs"].map(|end| format!("benches/{folder}{name}{end}"))
                        })
                        .collect(),
                    "-p" if name.starts_with(|c: char| c.is_alphabetic()) => {
                        let folder = name.trim_end_matches("-benches");
                        ["", "examples/", "benches/"]
                            .map(|parent| format!("{parent}{folder}/Cargo.toml"))
                            .to_vec()
                    }
                    _ => continue,
                };
                let is_target = name.starts_with(|c: char| c.is_alphabetic());
                if is_target && !places.iter().any(|place| root(place).exists()) {
                    lost.push(format!("{document}:{number}: {} {name}", pair[0]));
                }
            }
        }
    }
    assert!(lost.is_empty(), "no such targets:\n{}", lost.join("\n"));
}

#[test]
fn every_test_file_is_part_of_its_binary() {
    let mut lost = Vec::new();
    for (path, _) in files("tests", "rs") {
        let (folder, name) = path.rsplit_once('/').expect("a file is in a folder");
        let name = name.trim_end_matches(".rs");
        let Ok(main) = fs::read_to_string(root(folder).join("main.rs")) else {
            lost.push(format!("{path} is in no binary's folder"));
            continue;
        };
        let is_known =
            name == "main" || lines(&main).any(|(_, line)| line == format!("mod {name};"));
        if !is_known {
            lost.push(format!("{path} is missing in its main.rs"));
        }
    }
    assert!(
        lost.is_empty(),
        "tests that are never run:\n{}",
        lost.join("\n")
    );
}
