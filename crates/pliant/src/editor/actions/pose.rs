//! The menu *Pose*.

use egui::Key;

use super::actions;
use super::entry::{CTRL, CTRL_SHIFT, Entry, NONE};
use crate::document::Command;
use crate::editor::{EditorApp, Session};
use crate::tools::{Input, ToolKey, ToolKind};

actions! {
    /// Removes the active or hovered group.
    DELETE_HANDLE = Entry::new(
        "pose.delete-handle",
        "Delete handle",
        "Let go of the handle or anchor under the pointer, or of the active one",
    )
    .key(NONE, Key::Delete)
    .key(NONE, Key::Backspace)
    .unless(no_handle_to_delete)
    .does(delete_handle);
    /// Everything back to rest.
    RESET_POSE = Entry::new("pose.reset", "Reset pose", "Put all handles and the surface back to rest")
        .key(CTRL, Key::R)
        .does(|session| session.apply(Command::ResetPose));
    /// Puts the current pose on the strip.
    KEEP_POSE = Entry::new("pose.keep", "Keep pose", "Put handles and surface as they are now on the strip of poses")
        .key(NONE, Key::K)
        .apart()
        .does(Session::keep_pose);
    /// Makes the chosen pose what is shown now.
    UPDATE_POSE = Entry::new(
        "pose.update",
        "Update pose",
        "Replace the chosen pose of the strip by what handles and surface are now",
    )
    .unless(nothing_to_update)
    .does(Session::update_chosen_pose);
    /// Takes the chosen pose off the strip.
    DELETE_POSE = Entry::new("pose.delete", "Delete pose", "Take the chosen pose off the strip")
        .unless(no_pose_chosen)
        .does(Session::delete_chosen_pose);
    /// Shows the pose before.
    PREVIOUS_POSE = Entry::new("pose.previous", "Previous pose", "Show the pose before the chosen one, or else the last")
        .key(NONE, Key::PageUp)
        .unless(no_poses)
        .does(|session| session.step_pose(-1));
    /// Shows the pose behind.
    NEXT_POSE = Entry::new("pose.next", "Next pose", "Show the pose behind the chosen one, or else the first")
        .key(NONE, Key::PageDown)
        .unless(no_poses)
        .does(|session| session.step_pose(1));
    /// Moves the chosen pose to the left.
    POSE_EARLIER = Entry::new("pose.earlier", "Move pose earlier", "Move the chosen pose one place to the left")
        .unless(nothing_earlier)
        .does(|session| session.place_chosen_pose(-1));
    /// Moves the chosen pose to the right.
    POSE_LATER = Entry::new("pose.later", "Move pose later", "Move the chosen pose one place to the right")
        .unless(nothing_later)
        .does(|session| session.place_chosen_pose(1));
    /// Plays the kept poses.
    PLAY = Entry::new("pose.play", "Play", "Play the kept poses, or pause; handles are interpolated and the surface is solved")
        .key(NONE, Key::Space)
        .on(|session| session.player().is_some_and(crate::posing::Player::is_playing))
        .unless(Session::play_obstacle)
        .does(Session::toggle_play);
    /// Asks what the poses are to be written as.
    EXPORT_POSES = Entry::new(
        "pose.export",
        "Export poses…",
        "Write the kept poses as an animated glTF, or as numbered meshes or pictures",
    )
    .key(CTRL_SHIFT, Key::E)
    .unless(nothing_to_export)
    .window(EditorApp::ask_how_to_export_poses);
    /// The strip on screen.
    STRIP = Entry::new("pose.strip", "Strip of poses", "Show the kept poses below the picture, or hide them")
        .on(Session::strip_is_open)
        .does(Session::toggle_strip);
}

fn no_poses(session: &Session) -> Option<&'static str> {
    session.poses().is_empty().then_some("No pose is kept yet")
}

fn no_pose_chosen(session: &Session) -> Option<&'static str> {
    session.chosen_pose().is_none().then_some("Choose a pose on the strip first")
}

fn nothing_to_update(session: &Session) -> Option<&'static str> {
    let (chosen, document) = (session.chosen_pose(), session.document()?);
    let Some(chosen) = chosen else { return no_pose_chosen(session) };
    let is_same = std::sync::Arc::ptr_eq(&chosen.positions, &document.pose().positions);
    is_same.then_some("The chosen pose is what is shown now")
}

fn nothing_earlier(session: &Session) -> Option<&'static str> {
    let chosen = session.chosen_pose().map(|kept| kept.id);
    let is_first = chosen.is_some() && session.poses().first().map(|kept| kept.id) == chosen;
    no_pose_chosen(session).or_else(|| is_first.then_some("It is the first pose"))
}

fn nothing_later(session: &Session) -> Option<&'static str> {
    let chosen = session.chosen_pose().map(|kept| kept.id);
    let is_last = chosen.is_some() && session.poses().last().map(|kept| kept.id) == chosen;
    no_pose_chosen(session).or_else(|| is_last.then_some("It is the last pose"))
}

fn holds_handles(kind: ToolKind) -> bool {
    matches!(kind, ToolKind::Handle | ToolKind::Anchor)
}

fn no_handle_to_delete(session: &Session) -> Option<&'static str> {
    let has_one = holds_handles(session.tool_kind()) || !session.document()?.scene().active.is_empty();
    (!has_one).then_some("Choose a handle in the list first")
}

/// The handle tools know what is under the pointer; with another tool in hand the active group goes.
fn delete_handle(session: &mut Session) {
    if holds_handles(session.tool_kind()) {
        let before = session.document().map(|document| document.revision());
        session.input(Input::Key(ToolKey::Delete));
        if session.document().map(|document| document.revision()) == before {
            session.refuse(crate::editor::Action::DELETE_HANDLE, "Point at a handle or anchor, or click one first");
        }
    } else if let Some(ids) = session.document().map(|document| document.scene().active.ids().to_vec()) {
        session.apply(Command::Release(ids));
    }
}

fn nothing_to_export(session: &Session) -> Option<&'static str> {
    let is_busy = session.exporting_poses().is_some();
    no_poses(session).or_else(|| is_busy.then_some("The poses are being exported already"))
}
