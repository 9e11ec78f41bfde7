//! Imports between modules run one way, by the `use` declarations outside of tests.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use crate::{files, root};

/// The names of a module, from the root on.
type Module = Vec<String>;

/// What each module imports: from which module, and the name there.
struct Imports(BTreeMap<Module, Vec<(Module, String)>>);

/// Folders whose files implement a type of the folder's own `mod.rs`.
const PARTS_OF_ONE_TYPE: [&str; 4] = ["hull", "parry::hull_cache", "parry::hull_shape", "simplex"];

/// The paths of a `use` declaration, one by one.
fn paths(tree: &str) -> Vec<String> {
    let Some((head, rest)) = tree.split_once('{') else {
        return vec![tree.trim().to_owned()];
    };
    let inner = rest.rsplit_once('}').expect("a closing brace").0;
    let mut depth = 0;
    let between = |c: char| {
        depth += i32::from(c == '{') - i32::from(c == '}');
        c == ',' && depth == 0
    };
    let items = inner.split(between).filter(|item| !item.trim().is_empty());
    let inner = items.flat_map(paths);
    inner.map(|path| format!("{}{path}", head.trim())).collect()
}

/// The paths of all `use` declarations outside of tests.
fn declarations(text: &str) -> Vec<String> {
    let code = text.split("#[cfg(test)]\n").next().unwrap_or_default();
    let lines = code
        .lines()
        .map(str::trim)
        .filter(|line| !line.starts_with("//"));
    let code = format!(" {}", lines.collect::<Vec<_>>().join(" "));
    let trees = code
        .split(" use ")
        .skip(1)
        .filter_map(|part| part.split_once(';'));
    trees.flat_map(|(tree, _)| paths(tree)).collect()
}

impl Imports {
    fn read() -> Self {
        let files = files("src", "rs").into_iter();
        let files = files.filter(|(path, _)| !path.ends_with("/tests.rs"));
        let texts = files.map(|(path, text)| {
            let path = path.trim_start_matches("src/").trim_end_matches(".rs");
            let names = path
                .split('/')
                .filter(|name| !["mod", "lib"].contains(name));
            (names.map(str::to_owned).collect(), text)
        });
        let texts: BTreeMap<Module, String> = texts.collect();
        let imports = texts.iter().map(|(module, text)| {
            let found = declarations(text).into_iter();
            let found = found.map(|path| resolve(&texts, module, &path));
            (module.clone(), found.collect())
        });
        Self(imports.collect())
    }

    /// The module that a name comes from, through modules that only hand it on.
    fn source(&self, module: &Module, name: &str) -> Module {
        let handed_on = |(from, there): &&(Module, String)| there == name && from != module;
        match self.0[module].iter().find(handed_on) {
            Some((from, _)) => self.source(from, name),
            None => module.clone(),
        }
    }

    /// All pairs of a module and one that it imports from.
    fn edges(&self) -> impl Iterator<Item = (&Module, Module)> {
        self.0.iter().flat_map(move |(module, found)| {
            let sources = found.iter().map(|(from, name)| self.source(from, name));
            sources.map(move |from| (module, from))
        })
    }
}

/// The module of a path, and the name there. Of a path into another crate this is the module at hand.
fn resolve(all: &BTreeMap<Module, String>, here: &Module, path: &str) -> (Module, String) {
    let path = path.split(" as ").next().unwrap_or_default();
    let mut names = path.split("::").map(str::trim).peekable();
    let mut module = here.clone();
    if names.next_if_eq(&"crate").is_some() {
        module.clear();
    }
    while names.next_if_eq(&"super").is_some() {
        module.pop();
    }
    while let Some(name) = names.peek() {
        let inner = [&module[..], &[(*name).to_owned()]].concat();
        if !all.contains_key(&inner) {
            break;
        }
        module = inner;
        names.next();
    }
    (module, names.next().unwrap_or_default().to_owned())
}

/// The imports among the children of each folder, each child with all that is in it.
fn siblings(imports: &Imports) -> BTreeMap<&[String], BTreeSet<(String, String)>> {
    let mut found: BTreeMap<&[String], BTreeSet<(String, String)>> = BTreeMap::new();
    for (module, from) in imports.edges() {
        let common = module.iter().zip(&from).take_while(|(a, b)| a == b).count();
        if let (Some(user), Some(used)) = (module.get(common), from.get(common)) {
            let edges = found.entry(&module[..common]).or_default();
            edges.insert((user.clone(), used.clone()));
        }
    }
    found
}

#[test]
fn imports_have_no_cycles() {
    let imports = Imports::read();
    let folders = siblings(&imports);
    assert!(
        folders.values().map(BTreeSet::len).sum::<usize>() > 300,
        "imports were found"
    );
    for (folder, mut edges) in folders {
        // A child that imports from no sibling is in no cycle, and neither are imports of it.
        loop {
            let users: BTreeSet<String> = edges.iter().map(|(user, _)| user.clone()).collect();
            let before = edges.len();
            edges.retain(|(_, used)| users.contains(used));
            if edges.len() == before {
                break;
            }
        }
        assert!(edges.is_empty(), "in `{}`: {edges:?}", folder.join("::"));
    }
}

#[test]
fn children_do_not_import_from_their_folder() {
    for (module, from) in Imports::read().edges() {
        let is_child = module.len() > from.len() && module.starts_with(&from);
        let folder = from.join("::");
        let is_part = from.is_empty() || PARTS_OF_ONE_TYPE.contains(&&*folder);
        assert!(
            !is_child || is_part,
            "{} imports from {folder}",
            module.join("::")
        );
    }
}

/// The first table of `ARCHITECTURE.md` lists the modules from the bottom to the top.
#[test]
fn modules_use_only_those_above_them() {
    let map = fs::read_to_string(root("ARCHITECTURE.md")).expect("a map");
    let table = map.lines().skip_while(|line| !line.starts_with('|'));
    let rows = table.take_while(|line| line.starts_with('|'));
    let names = rows.flat_map(|row| row.split('|').nth(1).unwrap_or_default().split('`'));
    let order: Vec<&str> = names.collect();
    let place = |name: &str| {
        let place = order.iter().position(|listed| *listed == name);
        place.unwrap_or_else(|| panic!("`{name}` is not in the table"))
    };
    let imports = Imports::read();
    for (user, used) in &siblings(&imports)[&[][..]] {
        assert!(place(used) < place(user), "`{user}` uses `{used}`");
    }
}
