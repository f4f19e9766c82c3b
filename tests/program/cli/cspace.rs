//! The configuration space as files: by their names, by the schema, and as GeoJSON.

use super::*;

fn schema(kind: &str) -> String {
    read(shipped(&format!("docs/{kind}.schema.json")))
}

#[test]
fn schemas_are_those_of_the_book() {
    for kind in ["world", "cspace"] {
        let printed = Place::new().run(&["schema", kind], "");
        assert_eq!((printed.code, printed.stdout), (0, schema(kind)));
    }
}

#[test]
fn files_satisfy_the_schema() {
    let schema: Value = serde_json::from_str(&schema("cspace")).unwrap();
    let validator = jsonschema::draft202012::new(&schema).unwrap();
    let place = Place::new();
    let task = [shipped("robots/scara.urdf"), shipped("workspaces/tasks/kitting_cell.toml")];
    let circles = [shipped("robots/planar_2r_continuous.urdf"), shipped("workspaces/wrap_around.toml")];
    for (files, planner, has) in [
        (&task, "shortest", "rows"),
        (&circles, "harmonic", "grid"),
        (&circles, "prm", "roadmap"),
        (&shelf(), "trapezoid", "cells"),
        (&shelf(), "wavefront", "grid"),
        (&shelf(), "subdivision", "boxes"),
    ] {
        let outputs = "--quiet --output cspace.json --output Shelf.CSpace.JSON --output shelf.geojson";
        let done = place.run(files, &format!("--planner {planner} {outputs}"));
        assert_eq!((done.code, done.stdout.as_str()), (0, ""), "{}", done.stderr);
        let text = place.read("cspace.json");
        assert_eq!(text, place.read("Shelf.CSpace.JSON"));
        let spaces: Value = serde_json::from_str(&text).unwrap();
        let errors: Vec<String> =
            validator.iter_errors(&spaces).map(|e| format!("{}: {e}", e.instance_path())).collect();
        assert!(errors.is_empty(), "{planner}: {}", errors.join("; "));
        let space = &spaces["spaces"][0];
        assert_eq!(space.get(has).is_some(), files != &task, "{planner}");
        assert_eq!((&spaces["status"], &spaces["planner"]), (&"found".into(), &planner.into()));
        let topology = if files == &circles { "circle" } else { "interval" };
        assert!(
            spaces["axes"].as_array().unwrap().iter().all(|axis| axis["topology"] == topology),
            "{}",
            spaces["axes"]
        );

        let features = place.json("shelf.geojson");
        assert_eq!(features["type"], "FeatureCollection");
        let of = |kind: &str| {
            let all = features["features"].as_array().unwrap().iter();
            all.filter(|f| f["properties"]["kind"] == kind && f["properties"]["space"] == 0).collect::<Vec<_>>()
        };
        for (feature, obstacle) in of("c_obstacle").iter().zip(space["c_obstacles"].as_array().unwrap()) {
            assert_eq!(feature["geometry"]["type"], "MultiPolygon");
            assert_eq!(feature["geometry"]["coordinates"], obstacle["polygons"]);
            assert_eq!(
                (&feature["properties"]["name"], &feature["properties"]["proves"]),
                (&obstacle["obstacle"], &space["proves"])
            );
        }
        assert_eq!(of("c_obstacle").len(), space["c_obstacles"].as_array().unwrap().len());
        assert_eq!(of("path")[0]["geometry"]["coordinates"], space["paths"][0]["outline"]);
        assert_eq!(of("start")[0]["geometry"]["coordinates"], space["start"]);
        assert_eq!(of("cell").len(), space["cells"]["corners"].as_array().map_or(0, Vec::len));
        assert_eq!(of("roadmap").len(), usize::from(space.get("roadmap").is_some()));
    }
    // Other file names are those of results, as usual. An exploration has no such file.
    let done = place.run(&shelf(), "--quiet --output mycspace.json");
    assert_eq!((done.code, place.read("mycspace.json").contains("\"trajectory\"")), (0, true));
    let files = ["explore".to_owned(), shipped("robots/planar_2r.urdf"), shipped("workspaces/shelf.toml")];
    place.run(&files, "--output cspace.json").refused(2, &["cspace.json", "an exploration's name must end in"]);
}
