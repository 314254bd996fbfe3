//! Anything a hand can do, in any order.

use super::*;

/// Two seconds of it; 300 seeds of 2,000 actions have passed as well.
const SEEDS: u64 = 12;
const ACTIONS: usize = 1500;

/// A small generator (xorshift), so that a failure can be repeated by its seed.
struct Dice(u64);

impl Dice {
    fn below(&mut self, end: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % end
    }

    fn px(&mut self) -> Vec2 {
        // A little beyond the viewport of 800 × 600 on every side.
        Vec2::new(self.below(840) as f32 - 20.0, self.below(640) as f32 - 20.0)
    }

    fn pointer(&mut self) -> Pointer {
        let modifiers = Modifiers { shift: self.below(4) == 0, ctrl: self.below(4) == 0, alt: self.below(4) == 0 };
        Pointer { px: self.px(), modifiers }
    }
}

fn act(session: &mut Session, dice: &mut Dice) {
    match dice.below(16) {
        0 => session.take_tool(ToolKind::ALL[dice.below(5) as usize]),
        1..=3 => session.input(Input::Press(dice.pointer())),
        4..=7 => session.input(Input::Drag(dice.pointer())),
        8..=9 => session.input(Input::Release(dice.pointer())),
        10 => session.input(Input::Hover(dice.pointer())),
        11 => {
            let keys = [
                ToolKey::Escape,
                ToolKey::Delete,
                ToolKey::Eyedropper,
                ToolKey::Pivot,
                ToolKey::Sign(['-', '.', '3'][dice.below(3) as usize]),
                ToolKey::Axis(dice.below(3) as usize),
                ToolKey::Erase,
                ToolKey::Enter,
            ];
            session.input([Input::Leave, Input::Key(keys[dice.below(8) as usize])][dice.below(2) as usize]);
        }
        12 => session.undo(),
        13 => session.redo(),
        14 => command(session, dice),
        _ => {
            session.choose_rigidity(1 + dice.below(8) as u16);
            session.options.select_through = dice.below(2) == 0;
            paint_otherwise(session, dice);
            session.options.patch_rings = dice.below(4) as u16;
            if let Some(open) = session.open_mut() {
                open.camera.orbit(Vec2::new(dice.below(40) as f32, dice.below(40) as f32));
            }
        }
    }
    session.poll();
    if dice.below(8) == 0 {
        std::thread::sleep(Duration::from_millis(1)); // lets the solver get a word in
    }
}

fn paint_otherwise(session: &mut Session, dice: &mut Dice) {
    use pliant::tools::{BrushReach, FillBoundary, MirrorKind};
    let paint = &mut session.options.paint;
    paint.boundary = FillBoundary::ALL[dice.below(5) as usize].0;
    paint.reach = [BrushReach::Surface, BrushReach::Front, BrushReach::Through][dice.below(3) as usize];
    paint.mirror.kind = [MirrorKind::Off, MirrorKind::Plane, MirrorKind::Topology][dice.below(3) as usize];
    match dice.below(6) {
        0 => session.lock_current_rigidity(true),
        1 => session.lock_all(false),
        2 => session.options.brush_mode = BrushMode::Lock,
        _ => session.options.brush_mode = BrushMode::Set,
    }
}

fn command(session: &mut Session, dice: &mut Dice) {
    let group = document(session).scene().groups.first().map(|group| group.id);
    let vertex = VertexId(dice.below(500) as u32); // some do not exist
    let command = match (dice.below(13), group) {
        (0, Some(id)) => Command::ReturnToRest(id),
        (1, Some(id)) => Command::SetKind(id, GroupKind::Anchor),
        (2, Some(id)) => Command::Release(vec![id]),
        (3, Some(group)) => Command::Move { group, motion: glam::DAffine3::from_rotation_y(dice.below(7) as f64) },
        (4, _) => Command::ResetPose,
        (5, _) => Command::FillAll(dice.below(4) as u16),
        (6, _) => Command::Select(vec![vertex], SelectMode::Add),
        (7, Some(id)) => Command::AddToGroup(id, vec![vertex]),
        (8, Some(id)) => Command::RemoveFromGroup(id, vec![vertex]),
        (9, Some(_)) => Command::Merge(document(session).scene().groups.iter().map(|group| group.id).take(3).collect()),
        (10, Some(_)) => {
            let all = document(session).scene().groups.iter().map(|group| group.id).collect();
            Command::ActivateSeveral(all)
        }
        (11, _) => Command::SetLoose(pliant_solver::LooseComponents::KeepAtRest),
        _ => Command::Hold { kind: GroupKind::Handle, vertices: vec![vertex] },
    };
    session.apply(command);
}

#[test]
fn whatever_is_done_everything_stays_finite_and_undo_leads_back_to_the_start() {
    for seed in 1..=SEEDS {
        let mut dice = Dice(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let mut session = session_with(sheet(20));
        let start = document(&session).snapshot();
        for step in 0..ACTIONS {
            act(&mut session, &mut dice);
            let finite = document(&session).pose().positions.iter().all(|p| p.is_finite());
            assert!(finite, "seed {seed}, step {step}: a position is not finite");
        }
        session.take_tool(ToolKind::Handle);
        for _ in 0..=document(&session).history().len() {
            session.undo();
        }
        settle(&mut session);
        let end = document(&session);
        assert!(end.history().is_empty(), "seed {seed}: {} steps are left", end.history().len());
        assert_eq!(end.pose().positions, start.pose.positions, "seed {seed}: positions");
        assert_eq!(end.scene().rigidity, start.scene.rigidity, "seed {seed}: rigidity");
        assert_eq!(end.scene().groups, start.scene.groups, "seed {seed}: groups");
        assert_eq!(end.scene().selection, start.scene.selection, "seed {seed}: selection");
    }
}
