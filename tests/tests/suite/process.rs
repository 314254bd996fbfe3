//! The program as a process of its own: real streams, real exit codes.

use std::process::{Command, Output};

use pliant_tests::program::Folder;

fn start(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pliant-under-test"))
        .args(arguments)
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .output()
        .expect("the program starts")
}

#[test]
fn a_deformation_from_the_shell_writes_its_output() {
    let folder = Folder::new();
    let mesh = folder.write("square.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n");
    let handles = folder.write("handles.json", r#"{"fixed": [0, 1], "moved": [{"vertex": 2, "to": [1, 1, 0.5]}]}"#);
    let out = folder.path("out.obj");
    let output = start(&["deform", &mesh, "--handles", &handles, "-o", &out]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert_eq!(folder.names(), ["handles.json", "out.obj", "square.obj"]);
}

#[test]
fn failures_and_wrong_usage_have_their_exit_codes() {
    assert_eq!(start(&["info", "nowhere.obj"]).status.code(), Some(1));
    assert_eq!(start(&["info"]).status.code(), Some(2));
}

/// Elsewhere a display is part of the system and cannot be taken away by the environment.
#[test]
#[cfg(target_os = "linux")]
fn the_editor_without_a_display_says_so_and_points_to_the_command_line() {
    let output = start(&[]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(said.lines().any(|line| line.starts_with("pliant: ") && line.contains("command line")), "{said}");
    assert!(said.contains("no display: neither X11 nor Wayland can be reached"), "{said}");
    assert!(!said.contains(".rs:"), "a source file of the machine that built the program: {said}");
}
