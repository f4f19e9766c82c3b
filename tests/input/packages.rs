//! Checks that packages are found by the name in their `package.xml`, not by the names of their folders.

use cplan::input::load_scene;
use std::fs;
use std::path::Path;

/// The mesh of a pyramid.
const MESH: &str = "v 0 -0.05 0\nv 0 0.05 0\nv 0.5 0 0\nv 0 0 0.1\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 1 3 4\n";

fn write(path: &Path, text: &str) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, text).unwrap();
}

fn manifest(name: &str) -> String {
    format!("<?xml version=\"1.0\"?>\n<package format=\"3\">\n  <name> {name} </name>\n</package>\n")
}

fn urdf(mesh: &str) -> String {
    format!(
        "<robot name=\"arm\"><link name=\"a\"/><link name=\"b\"><collision><geometry><mesh filename=\"{mesh}\"/></geometry></collision></link>\
         <link name=\"c\"/><joint name=\"j1\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/><axis xyz=\"0 0 1\"/></joint>\
         <joint name=\"j2\" type=\"continuous\"><parent link=\"b\"/><child link=\"c\"/><origin xyz=\"0.5 0 0\"/><axis xyz=\"0 0 1\"/></joint></robot>"
    )
}

/// Creates a repository with packages in it, one beside another and one in a subfolder. No package has the name of its
/// folder.
fn repository() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    fs::create_dir(root.join(".git")).unwrap();
    write(&root.join("world.toml"), "");
    for (place, name) in [
        ("arm-main", "arm_description"),
        ("shapes-main", "arm_meshes"),
        ("more/vendor/x", "arm_vendor"),
        ("called", "other"),
    ] {
        write(&root.join(place).join("package.xml"), &manifest(name));
        write(&root.join(place).join("meshes/bar.obj"), MESH);
    }
    folder
}

fn load(root: &Path, mesh: &str) -> Result<(), String> {
    let file = root.join("arm-main/urdf/arm.urdf");
    write(&file, &urdf(mesh));
    load_scene(&file, &root.join("world.toml")).map(|_| ()).map_err(|error| error.to_string())
}

#[test]
fn meshes_are_found_by_the_name_in_package_xml() {
    let folder = repository();
    for name in ["arm_description", "arm_meshes", "arm_vendor", "called"] {
        load(folder.path(), &format!("package://{name}/meshes/bar.obj")).unwrap();
    }
    let error = load(folder.path(), "package://nobody/meshes/bar.obj").unwrap_err();
    assert!(error.contains("no package of this name") && error.contains("ROS_PACKAGE_PATH"), "{error}");
    let error = load(folder.path(), "package://arm_meshes/meshes/none.obj").unwrap_err();
    assert!(error.contains("shapes-main/meshes/none.obj"), "{error}");
}

/// Checks that packages of a neighbouring repository are not found.
#[test]
fn the_search_ends_at_the_repository() {
    let outer = tempfile::tempdir().unwrap();
    write(&outer.path().join("other/package.xml"), &manifest("arm_meshes"));
    write(&outer.path().join("other/meshes/bar.obj"), MESH);
    let root = outer.path().join("mine");
    fs::create_dir_all(root.join(".git")).unwrap();
    write(&root.join("world.toml"), "");
    let error = load(&root, "package://arm_meshes/meshes/bar.obj").unwrap_err().to_string();
    assert!(error.contains("arm_meshes"), "{error}");
}
