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
fn an_action_that_is_in_no_state_to_be_done_says_why_for_a_moment() {
    let mut session = session_with(sheet(4));
    for action in Action::all().filter(|action| *action != Action::TOOL_HANDLE) {
        session.take_tool(ToolKind::Handle);
        if let Some(why) = action.obstacle(&session) {
            action.perform_in(&mut session);
            let said = session.aside().unwrap_or_default();
            assert!(said.contains(why) && said.contains(action.label()), "{action:?} only says {said:?}");
        }
    }
    session.tick(Instant::now() + Duration::from_secs(60));
    assert_eq!(session.aside(), None, "it stays");
    // Keys that act on what is under the pointer, while nothing is.
    for (tool, action) in [(ToolKind::Handle, Action::DELETE_HANDLE), (ToolKind::Brush, Action::EYEDROPPER)] {
        session.take_tool(tool);
        session.input(Input::Leave);
        assert!(action.perform_in(&mut session));
        let said = session.aside().unwrap_or_default();
        assert!(said.contains("first"), "{action:?} says {said:?}");
    }
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
