//! What the mouse does, for the sheet of keys: of each tool, and of the view whichever tool is in hand.

use super::ToolKind;

/// A gesture and what it does.
pub type Gesture = (&'static str, &'static str);

/// With every tool.
pub const VIEW_GESTURES: &[Gesture] = &[
    ("Middle or right drag, Alt + left drag", "turn the view"),
    ("Shift + middle or right drag, Alt + middle drag", "move the view"),
    ("Wheel, pinch, Alt + right drag", "zoom toward the pointer"),
    ("F held while moving the mouse", "radius of the brush"),
    ("1 … 9, two digits typed quickly", "current rigidity"),
    ("Esc", "take back the drag or stroke under way; close a dialog"),
];

impl ToolKind {
    /// What the left button does with this tool in hand.
    pub const fn gestures(self) -> &'static [Gesture] {
        match self {
            ToolKind::Handle => &[
                ("Click the surface", "a handle there"),
                ("Drag a handle", "bend the surface"),
                ("Shift + click handles", "work on several"),
                ("Drag an arrow, square, ring or knob of the gizmo", "move, turn or scale"),
                ("Click one and type a number, Enter", "move, turn or scale by exactly that"),
                ("X, Y, Z while dragging", "lock an axis"),
                ("Shift while dragging", "keep to the nearest axis"),
                ("Ctrl while dragging", "steps of the grid, of 15°, of a tenth"),
                ("Alt while dragging", "onto the vertex near the pointer"),
            ],
            ToolKind::Anchor => &[
                ("Click the surface", "hold it where it is"),
                ("Click an anchor", "choose it"),
                ("Shift + click anchors", "choose several"),
            ],
            ToolKind::Select => &[
                ("Drag", "select what is inside of the box or lasso, or under the brush"),
                ("Shift while selecting", "add"),
                ("Ctrl while selecting", "remove"),
                ("Click", "select a vertex"),
                ("Double click", "select all that is linked"),
            ],
            ToolKind::Brush => &[
                ("Drag over the surface", "paint the current rigidity"),
                ("Ctrl while painting", "softer, or unlock"),
                ("Shift while painting", "smooth"),
            ],
            ToolKind::Fill => &[
                ("Click the surface", "fill the region that is shown"),
                ("Drag over the surface", "fill around the pressed point, as far as the drag"),
            ],
            ToolKind::Inspect => &[
                ("Point at the surface", "read the numbers of a vertex"),
                ("Click", "pin it"),
                ("Click another vertex", "measure the way to it"),
            ],
        }
    }
}
