//! The flood fill tool.

use super::{Context, Cursor, Input, Marks, Pick, Reaction, Tool, ToolKey};
use crate::document::{Command, region_of_equal_rigidity};

/// Fills the selection if the click is in it, else the region of equal r around the click.
#[derive(Default)]
pub(super) struct FillTool {
    hover: Option<Pick>,
}

impl Tool for FillTool {
    fn handle(&mut self, input: Input, context: &mut Context<'_>) -> Reaction {
        match input {
            Input::Hover(pointer) => self.hover = context.surface.pick(pointer.px, &context.view),
            Input::Leave => self.hover = None,
            Input::Press(pointer) => {
                let Some(pick) = context.surface.pick(pointer.px, &context.view) else {
                    return Reaction::default();
                };
                let scene = context.document.scene();
                let vertices = if scene.selection.contains(pick.vertex) {
                    scene.selection.vertices().to_vec()
                } else {
                    region_of_equal_rigidity(&context.document.model().mesh, &scene.rigidity, pick.vertex)
                };
                return vec![Command::Fill { vertices, r: context.options.rigidity }].into();
            }
            Input::Key(ToolKey::Eyedropper) => {
                let r = self.hover.map(|pick| context.document.scene().rigidity.as_slice()[pick.vertex.index()]);
                return Reaction { commands: Vec::new(), rigidity: r };
            }
            _ => {}
        }
        Reaction::default()
    }

    fn hint(&self, context: &Context<'_>) -> String {
        let r = context.options.rigidity;
        let scene = context.document.scene();
        match self.hover {
            Some(pick) if scene.selection.contains(pick.vertex) => {
                format!("Click fills the {} selected vertices with rigidity {r}", scene.selection.vertices().len())
            }
            Some(pick) => {
                let here = scene.rigidity.as_slice()[pick.vertex.index()];
                format!("Click turns this region of rigidity {here} to {r} · number keys choose · I takes {here}")
            }
            None => format!("Click the surface to fill a region with rigidity {r}"),
        }
    }

    fn marks(&self, _context: &Context<'_>) -> Marks {
        Marks::default()
    }

    fn cursor(&self) -> Cursor {
        Cursor::Cross
    }

    fn is_active(&self) -> bool {
        false
    }
}
