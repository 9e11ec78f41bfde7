//! Recordings of pairs: what is written reads back to the bit, and what looks wrong is found.

use std::fs;
use std::io::{self, ErrorKind, Write};
use std::path::Path;
use std::sync::{Arc, Mutex};

use isa_gjk::IsaGjkDispatcher;
use isa_gjk::recording::{self, RecordedPair, Recorder, RecordingErrorKind as Kind, Suspicion};
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::TrackedContact;
use parry3d::shape::{PackedFeatureId, SharedShape};
use testkit::generate::Rng;
use testkit::memory::{Memory, cold_manifold};
use testkit::shape_samples::{ShapeSample, poses, shape_samples};

/// A file in memory.
#[derive(Clone, Default)]
struct Page(Arc<Mutex<Vec<u8>>>);

impl Page {
    fn text(&self) -> String {
        String::from_utf8(self.0.lock().expect("whole").clone()).expect("text")
    }

    fn pairs(&self) -> Vec<RecordedPair> {
        recording::read(&self.text()).expect("a recording")
    }
}

impl Write for Page {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().expect("whole").write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A dispatcher that records, the recorder, and what it writes to.
fn recording(change: impl FnOnce(Recorder) -> Recorder) -> (IsaGjkDispatcher, Arc<Recorder>, Page) {
    let page = Page::default();
    let recorder = Arc::new(change(Recorder::new(page.clone()).expect("memory")));
    let dispatcher = IsaGjkDispatcher::default().with_recorder(recorder.clone());
    (dispatcher, recorder, page)
}

fn all(recorder: Recorder) -> Recorder {
    recorder.of_all_pairs().with_limit(usize::MAX)
}

/// Pairs of all shapes that come together step by step, so that each update has a past. One of `each` poses is taken.
fn meet(dispatcher: &IsaGjkDispatcher, each: usize, is_meant: impl Fn(&ShapeSample) -> bool) {
    let mut samples = shape_samples();
    let mut rng = Rng::new(5);
    samples.extend((0..10).map(|_| ShapeSample {
        name: "any hull",
        has_hull: true,
        shape: rng.any_hull(1.0).shape,
    }));
    // Parry's routine for voxels refuses some pairs with a panic; normals on fields are corrected.
    let is_usual = |name: &str| !["voxels", "polyline", "heightfield"].contains(&name);
    samples.retain(|sample| is_usual(sample.name) && is_meant(sample));
    for a in &samples {
        for b in &samples {
            let mut memory = Memory::default();
            for pose in poses().iter().step_by(each) {
                memory.update(dispatcher, pose, [&a.shape, &b.shape], 0.05);
            }
        }
    }
}

#[test]
fn a_recording_that_is_replayed_is_recorded_to_the_bit() {
    let (dispatcher, recorder, page) = recording(all);
    meet(&dispatcher, 27, |_| true);
    let summary = recorder.summary();
    assert_eq!(summary.unknown_shapes, 0);
    assert!(summary.recorded > 2_000 && summary.recorded == summary.seen);
    assert_eq!(summary.bytes, page.text().len());

    let (dispatcher, _, again) = recording(all);
    let pairs = page.pairs();
    assert_eq!(pairs.len() as u64, summary.recorded);
    for pair in &pairs {
        let manifold = pair.update(&dispatcher);
        assert_eq!(manifold.points.len(), pair.after.points.len(), "{pair:?}");
    }
    assert!(page.text() == again.text(), "not the same bits");
}

#[test]
fn pairs_of_ours_do_not_look_wrong() {
    let (dispatcher, recorder, page) = recording(|recorder| recorder);
    let is_curved = |name: &str| name.contains("cylinder") || name.contains("cone");
    meet(&dispatcher, 9, |sample| !is_curved(sample.name));
    assert!(recorder.summary().seen > 5_000);
    assert_eq!(recorder.summary().recorded, 0, "{}", page.text());
}

/// One pair of a plain hull and a cuboid, 1 cm deep.
fn text() -> String {
    let (dispatcher, _, page) = recording(all);
    let corners = [Vector::ZERO, Vector::X, Vector::Y, Vector::Z];
    let hull = SharedShape::convex_hull(&corners).expect("a solid");
    let wall = SharedShape::cuboid(0.5, 5.0, 5.0);
    let pose = Pose::translation(0.49, 0.0, 0.0);
    cold_manifold(&dispatcher, &pose, [&wall, &hull], 0.05).expect("ours");
    page.text()
}

#[test]
fn what_is_wrong_has_a_name() {
    let pair = recording::read(&text()).expect("a recording").remove(0);
    assert_eq!((pair.suspicion, pair.judge()), (None, None));
    let changed = |change: &dyn Fn(&mut RecordedPair)| {
        let mut pair = pair.clone();
        change(&mut pair);
        pair.judge()
    };
    let shifted = |by: Real| {
        changed(&|pair| {
            pair.after
                .points
                .iter_mut()
                .for_each(|point| point.dist += by)
        })
    };
    let contact = |dist| {
        let id = PackedFeatureId::face(0);
        TrackedContact::new(Vector::ZERO, Vector::ZERO, id, id, dist)
    };
    let missing = changed(&|pair| pair.after.points.clear());
    assert_eq!(missing, Some(Suspicion::Missing));
    assert_eq!(shifted(Real::NAN), Some(Suspicion::NotFinite));
    assert_eq!(shifted(-0.01), Some(Suspicion::TooDeep));
    assert_eq!(shifted(0.01), Some(Suspicion::TooShallow));
    assert_eq!(shifted(1e-7), None, "f32 knows no better");
    let normal = changed(&|pair| pair.after.local_n2.x = Real::INFINITY);
    assert_eq!(normal, Some(Suspicion::NotFinite));
    let invented = changed(&|pair| {
        pair.pos12.translation.x = 0.56;
        pair.after.points = [contact(0.04)].into_iter().collect();
    });
    assert_eq!(invented, Some(Suspicion::Invented));
    let apart = changed(&|pair| {
        pair.pos12.translation.x = 0.56;
        pair.after.points.clear();
    });
    assert_eq!(apart, None);
    // Along a corrected normal the overlap may be anything but less.
    let corrected = |by| {
        changed(&|pair| {
            pair.has_corrected_normals = true;
            pair.after
                .points
                .iter_mut()
                .for_each(|point| point.dist += by);
        })
    };
    assert_eq!(corrected(-0.01), None);
    assert_eq!(corrected(0.01), Some(Suspicion::TooShallow));
}

#[test]
fn a_recording_ends_at_its_limit() {
    const LIMIT: usize = 10_000;
    let (dispatcher, recorder, page) =
        recording(|recorder| recorder.of_all_pairs().with_limit(LIMIT));
    meet(&dispatcher, 9, |sample| sample.has_hull);
    let summary = recorder.summary();
    assert!(summary.is_full);
    assert!(summary.bytes <= LIMIT && summary.bytes > LIMIT / 2);
    assert_eq!(
        summary.seen,
        summary.recorded + 1,
        "nobody looks at later pairs"
    );
    assert_eq!(page.text().len(), summary.bytes);
    let last = page.text().lines().last().expect("a line").to_owned();
    assert!(last.contains("limit"), "{last}");
    assert_eq!(page.pairs().len() as u64, summary.recorded);
}

/// Has room for this many bytes.
struct SmallDisk(usize);

impl Write for SmallDisk {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let left = self.0.checked_sub(bytes.len());
        self.0 = left.ok_or(ErrorKind::StorageFull)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn an_error_of_the_file_is_named_and_ends_no_step() {
    assert!(Recorder::create("/no/such/folder/pairs").is_err());
    let recorder = Recorder::new(SmallDisk(3000)).expect("room").of_all_pairs();
    let recorder = Arc::new(recorder);
    let dispatcher = IsaGjkDispatcher::default().with_recorder(recorder.clone());
    meet(&dispatcher, 9, |sample| sample.has_hull);
    let summary = recorder.summary();
    assert_eq!(summary.error, Some(ErrorKind::StorageFull));
    assert!(summary.recorded > 0 && !summary.is_full);
}

#[test]
fn bad_files_are_named() {
    let good = text();
    let line_of = |word: &str| {
        let line = good.lines().position(|line| line.starts_with(word));
        line.expect("a line") + 1
    };
    let cases = [
        ("isa-gjk pairs 1", "# mine", 1, Kind::NotARecording),
        ("pairs 1", "pairs 2", 1, Kind::UnknownVersion("2".into())),
        (
            "pair nothing",
            "pair strange",
            line_of("pair "),
            Kind::UnknownSuspicion("strange".into()),
        ),
        (
            "pair nothing",
            "pear nothing",
            line_of("pair "),
            Kind::Expected("pair"),
        ),
        ("pair nothing", "pair", line_of("pair "), Kind::MissingWord),
        (
            "shape cuboid",
            "shape cube",
            line_of("shape cuboid"),
            Kind::UnknownShape("cube".into()),
        ),
        (
            "cuboid 0.5 5.0 5.0",
            "cuboid 0.5 5.0",
            line_of("shape cuboid"),
            Kind::MissingWord,
        ),
        (
            "cuboid 0.5 5.0 5.0",
            "cuboid 0.5 5.0 5.0 1",
            line_of("shape cuboid"),
            Kind::ExtraWord("1".into()),
        ),
        (
            "cuboid 0.5",
            "cuboid x",
            line_of("shape cuboid"),
            Kind::NotANumber("x".into()),
        ),
        (
            "cuboid 0.5 5.0 5.0",
            "cylinder -0.5 5.0",
            line_of("shape cuboid"),
            Kind::BadShape,
        ),
        (
            "cuboid 0.5 5.0 5.0",
            "ball inf",
            line_of("shape cuboid"),
            Kind::BadShape,
        ),
        (
            "points 4",
            "points -4",
            line_of("points"),
            Kind::NotANumber("-4".into()),
        ),
        (
            "points 4",
            "points 3",
            line_of("points") + 4,
            Kind::Expected("triangles"),
        ),
        (
            "points 4",
            "points 5",
            line_of("triangles"),
            Kind::NotANumber("triangles".into()),
        ),
        (
            "prediction",
            "predicted",
            line_of("prediction"),
            Kind::Expected("prediction"),
        ),
    ];
    for (from, to, line, kind) in cases {
        let changed = good.replacen(from, to, 1);
        assert_ne!(changed, good, "{from} is not there");
        let error = recording::read(&changed).expect_err(to);
        assert_eq!((error.line, &error.kind), (line, &kind), "{to}");
        assert!(error.to_string().starts_with(&format!("line {line}: ")));
    }
    let open = good.replace("triangles 4", "triangles 2");
    let mut lines: Vec<&str> = open.lines().collect();
    lines.drain(line_of("triangles") + 2..line_of("triangles") + 4);
    let error = recording::read(&lines.join("\n")).expect_err("an open surface");
    assert_eq!(error.kind, Kind::BadShape);
    let mut cut: Vec<&str> = good.lines().collect();
    cut.truncate(line_of("before"));
    let error = recording::read(&cut.join("\n")).expect_err("no end");
    assert_eq!(
        (error.line, error.kind),
        (line_of("before"), Kind::EndsTooSoon)
    );
    assert_eq!(
        recording::read("").expect_err("nothing").kind,
        Kind::NotARecording
    );
    assert!(
        recording::read("isa-gjk pairs 1\n")
            .expect("none yet")
            .is_empty()
    );
}

/// Whatever happens to a file on its way, reading it ends in pairs or in an error.
#[test]
fn damaged_files_end_in_errors() {
    let good = text();
    let mut rng = Rng::new(9);
    let mut errors = 0;
    for _ in 0..20_000 {
        let mut bytes = good.clone().into_bytes();
        for _ in 0..rng.count(1, 4) {
            let at = rng.count(0, bytes.len().saturating_sub(1));
            match rng.count(0, 2) {
                0 if !bytes.is_empty() => bytes[at] = b"0123456789 .-e\n#aN"[rng.count(0, 17)],
                1 => drop(bytes.drain(at..(at + 1).min(bytes.len()))),
                _ => bytes.truncate(at.max(1)),
            }
        }
        let text = String::from_utf8(bytes).expect("no other characters");
        errors += usize::from(recording::read(&text).is_err());
    }
    assert!(errors > 10_000, "only {errors} errors");
}

/// Each file in `tests/data/pairs` was a report of a wrong contact, or stands for one.
#[test]
fn reported_pairs_look_right_now() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/pairs");
    let mut count = 0;
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let text = fs::read_to_string(&path).expect("text");
        let name = path.display();
        let pairs = recording::read(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
        for (i, pair) in pairs.iter().enumerate() {
            let after = pair.update(&IsaGjkDispatcher::default());
            let now = RecordedPair {
                after,
                ..pair.clone()
            };
            assert_eq!(now.judge(), None, "pair {i} of {name}");
            count += 1;
        }
    }
    assert!(count > 0);
}
