//! Habits that are to go. Each limit is what there was when it was last lowered: lower it with
//! the code, and never raise it.

use crate::{files, lines};

/// Names of our own that were replaced by those of the literature. They must not come back.
const PRIVATE_WORDS: [&str; 53] = [
    "dice",
    "Besides",
    "Shell",
    "Shells",
    "Slope",
    "Star",
    "Trail",
    "Top",
    "Highest",
    "heirs",
    "orphans",
    "Fan",
    "Workbench",
    "AnyHull",
    "HullTable",
    "Preparation",
    "InUse",
    "Unchanged",
    "Span",
    "valid_start",
    "four_corners",
    "face_beside",
    "has_balls_apart",
    "test_balls",
    "smaller_radius",
    "between_cores",
    "may_have_parts",
    "keep_shell",
    "is_far_sighted",
    "start_anew",
    "first_turn",
    "Ridge",
    "NoPlane",
    "Unproved",
    "look_further",
    "in_order",
    "surround",
    "leaves_out",
    "originals",
    "along_curve",
    "sort_fans",
    "IN_CAP",
    "add_caps",
    "stars_from",
    "is_crowded",
    "is_fragile",
    "shorten_reach",
    "take_beyond",
    "Survey",
    "keep_one",
    "Mover",
    "zoo",
    "Exhibit",
];
/// Files and folders in which `inline(always)` needs no note, and what calls in its place cost.
const HOT: [(&str, &[&str]); 3] = [
    (
        "on the way to a query: 6 % more instructions in separated/32",
        &[
            "src/pose",
            "src/support",
            "src/parry/order",
            "src/parry/operand",
            "src/parry/pair",
            "src/parry/visit",
        ],
    ),
    (
        "in a query: 2 % more instructions in touching/32, 4 % in resting/16",
        &[
            "src/gjk",
            "src/simplex",
            "src/query",
            "src/hull",
            "src/parry/half_space",
            "src/parry/hull_cache",
        ],
    ),
    (
        "values of four lanes go through memory: a tenth of a manifold's update without link-time optimisation",
        &[
            "src/simd",
            "src/arg_max",
            "src/manifold",
            "src/parry/manifold",
        ],
    ),
];
/// Lines of a file that one still overlooks.
const LONG_FILE: usize = 300;

/// Fails with all places if there are more than `limit`.
fn at_most(limit: usize, what: &str, places: &[String]) {
    assert!(
        places.len() <= limit,
        "{} {what}, and at most {limit} are allowed:\n{}",
        places.len(),
        places.join("\n")
    );
}

/// Places in `src` of lines that `is_meant`, by the line and the three before it.
fn places(is_meant: impl Fn(&str, &[&str]) -> bool) -> Vec<String> {
    let mut found = Vec::new();
    for (path, text) in files("src", "rs") {
        let all: Vec<&str> = text.lines().collect();
        for (number, line) in lines(&text) {
            if is_meant(line, &all[number.saturating_sub(4)..number - 1]) {
                found.push(format!("{path}:{number}: {}", line.trim()));
            }
        }
    }
    found
}

/// Files in `src` with a line that `is_meant`.
fn files_with(is_meant: impl Fn(&str) -> bool) -> Vec<String> {
    files("src", "rs")
        .into_iter()
        .filter(|(_, text)| text.lines().any(&is_meant))
        .map(|(path, _)| path)
        .collect()
}

fn words(line: &str) -> impl Iterator<Item = &str> {
    line.split(|c: char| !c.is_alphanumeric() && c != '_')
}

/// The reason is above the attribute, or it is that of its [`HOT`] file.
#[test]
fn forced_inlining_has_a_reason() {
    let is_forced = |line: &str| line.contains("#[inline(always)]");
    let found = places(|line, _| is_forced(line));
    at_most(179, "`inline(always)`", &found);
    let has_no_note = |before: &[&str]| !before.iter().any(|line| line.contains("// perf: "));
    let mut found = places(|line, before| is_forced(line) && has_no_note(before));
    found.retain(|place| {
        !HOT.iter()
            .any(|(_, files)| files.iter().any(|file| place.starts_with(file)))
    });
    at_most(0, "`inline(always)` without a `// perf:` note", &found);
}

#[test]
fn few_files_know_simd() {
    let found = files_with(|line| line.contains("use wide::"));
    at_most(1, "files import `wide`", &found);
}

/// Ids are types of their own: only other numbers are cast.
#[test]
fn few_integers_are_cast() {
    for (limit, targets) in [(50, &["usize"][..]), (15, &["u16", "u32"])] {
        let is_cast = |line: &str| {
            let mut pairs = words(line).zip(words(line).skip(1));
            pairs.any(|(word, to)| word == "as" && targets.contains(&to))
        };
        at_most(limit, "casts", &places(|line, _| is_cast(line)));
    }
}

/// What is left to parry is an error, [`Unsupported`](parry3d::query::Unsupported), not a second option.
#[test]
fn options_are_not_nested() {
    let found = places(|line, _| line.contains("Option<Option<"));
    at_most(0, "nested options", &found);
}

/// The order of the stages is written once: `Query::run_into`, and for half-spaces.
#[test]
fn the_pipeline_is_written_once() {
    for (limit, word) in [
        (2, "are_spheres_apart(self"),
        (3, "stats.record("),
        (0, "[Stage; 2]"),
    ] {
        let found = places(|line, _| line.contains(word));
        at_most(limit, word, &found);
    }
}

#[test]
fn interfaces_state_what_they_expect() {
    let found = places(|line, _| line.contains("debug_assert"));
    assert!(found.len() >= 20, "only {} assertions", found.len());
}

#[test]
fn float_constants_are_in_two_files() {
    let is_float = |line: &str| {
        line.contains("const ")
            && [": f32 =", ": f64 =", ": Real ="]
                .iter()
                .any(|t| line.contains(t))
    };
    let found: Vec<_> = places(|line, _| is_float(line))
        .into_iter()
        .filter(|place| !place.contains("src/tolerance") && !place.contains("src/tuning.rs"))
        .collect();
    at_most(
        0,
        "float constants outside tolerance.rs and tuning.rs",
        &found,
    );
}

#[test]
fn few_files_know_the_order_of_a_pair() {
    let found = files_with(|line| words(line).any(|word| word == "swapped"));
    at_most(0, "files with the word `swapped`", &found);
}

#[test]
fn names_are_those_of_the_field() {
    let found = places(|line, _| words(line).any(|word| PRIVATE_WORDS.contains(&word)));
    at_most(0, "lines with private words", &found);
}

#[test]
fn files_are_short() {
    let long = files("src", "rs").into_iter().filter_map(|(path, text)| {
        let count = text.lines().count();
        (count > LONG_FILE).then(|| format!("{path}: {count} lines"))
    });
    at_most(0, "files are long", &long.collect::<Vec<_>>());
}

/// What users find at the root, in `query` and in `recording`.
#[test]
fn few_names_are_public() {
    let modules = [
        "src/lib.rs",
        "src/query/mod.rs",
        "src/parry/recording/mod.rs",
    ];
    let mut names = Vec::new();
    for (path, text) in files("src", "rs") {
        if modules.contains(&&*path) {
            let public = text.lines().filter_map(|line| line.strip_prefix("pub "));
            let exported = public.filter(|line| !line.starts_with("mod "));
            let exported = exported.flat_map(|line| line.rsplit(['{', ':']).next());
            let own = exported.flat_map(|line| line.split(','));
            names.extend(own.map(|name| format!("{path}: {}", name.trim())));
        }
    }
    assert!(names.len() >= 20, "{names:?}");
    at_most(26, "public names, with that of `recording`", &names);
}

/// Where each function of a file begins, and how many lines it has.
fn functions(text: &str) -> Vec<(usize, usize)> {
    let all: Vec<&str> = text.lines().collect();
    let indent = |line: &str| line.len() - line.trim_start().len();
    let is_function =
        |line: &str| words(line).take(6).any(|word| word == "fn") && !line.contains("//");
    let mut found = Vec::new();
    for (first, line) in all.iter().enumerate().filter(|(_, line)| is_function(line)) {
        let same_column = |other: &&&str| indent(other) == indent(line) && !other.trim().is_empty();
        let after = all[first + 1..].iter();
        let closing = after
            .clone()
            .position(|other| same_column(&other) && other.trim() == "}");
        let next = after
            .clone()
            .position(|other| same_column(&other) && is_function(other));
        if let Some(closing) = closing
            && next.is_none_or(|next| closing < next)
        {
            found.push((first + 1, closing + 2));
        }
    }
    found
}

#[test]
fn functions_are_short() {
    let lengths = files("src", "rs").into_iter().flat_map(|(path, text)| {
        let found = functions(&text).into_iter();
        found.map(move |(line, length)| (length, format!("{path}:{line}: {length} lines")))
    });
    let mut long: Vec<(usize, String)> = lengths.filter(|(length, _)| *length > 40).collect();
    long.sort();
    let places: Vec<String> = long.iter().map(|(_, place)| place.clone()).collect();
    at_most(8, "functions are long", &places);
    assert!(
        long.last().is_none_or(|(length, _)| *length <= 60),
        "{long:?}"
    );
}

/// The name of a type that a line defines.
fn defined_type(line: &str) -> Option<&str> {
    let mut words = words(line).skip_while(|word| {
        matches!(
            *word,
            "pub" | "crate" | "super" | "in" | "hull" | "query" | ""
        )
    });
    let is_type = matches!(words.next()?, "struct" | "enum" | "trait");
    words.next().filter(|_| is_type)
}

#[test]
fn no_two_types_have_one_name() {
    let mut defined: Vec<(String, String)> = Vec::new();
    for (path, text) in files("src", "rs") {
        let names = text.lines().filter_map(defined_type);
        defined.extend(names.map(|name| (name.to_owned(), path.clone())));
    }
    defined.sort();
    let doubled = defined.windows(2).filter(|pair| pair[0].0 == pair[1].0);
    let doubled: Vec<String> = doubled
        .map(|pair| format!("{} in {} and {}", pair[0].0, pair[0].1, pair[1].1))
        .collect();
    at_most(0, "type names are defined twice", &doubled);
}
