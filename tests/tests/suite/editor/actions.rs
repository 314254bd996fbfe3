//! The table of actions, behind the window.

use super::*;

#[test]
fn every_action_with_nothing_open_can_be_done_or_says_to_open_a_mesh() {
    let mut session = Session::new(|| {}).expect("a solver thread");
    for action in Action::all() {
        if let Some(why) = action.obstacle(&session) {
            assert!(!why.is_empty(), "{action:?} refuses without a reason");
            assert!(!action.perform_in(&mut session), "{action:?} was done although {why}");
        } else {
            action.perform_in(&mut session);
        }
    }
    assert!(session.document().is_none());
}

#[test]
fn every_action_can_be_done_in_any_order_on_a_mesh_without_harm() {
    let mut session = session_with(sheet(4));
    for action in Action::all().chain(Action::all()) {
        action.perform_in(&mut session);
        session.poll();
    }
    settle(&mut session);
}

#[test]
fn a_tool_is_on_in_its_menu_while_it_is_in_hand() {
    let mut session = Session::new(|| {}).expect("a solver thread");
    for kind in ToolKind::ALL {
        let action = Action::of_tool(kind).unwrap_or_else(|| panic!("no action takes {kind:?} in hand"));
        assert!(action.perform_in(&mut session));
        let on: Vec<Action> = ToolKind::ALL
            .into_iter()
            .filter_map(Action::of_tool)
            .filter(|tool| tool.is_on(&session) == Some(true))
            .collect();
        assert_eq!(on, [action]);
    }
}
