//! Meshes that come with the program.

use pliant_meshfile::{Format, OpenOptions};
use pliant_solver::VertexId;

use crate::document::{Command, Document, GroupKind, Model, ModelError};

/// A mesh inside the program, with anchors so that the first pull already bends it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sample {
    /// What a newcomer sees first.
    Creature,
    /// Ribbed trunk with arms.
    Cactus,
    /// An open surface.
    Sheet,
    /// The paper's bar.
    Bar,
    /// The paper's thin bar.
    ThinBar,
    /// An animal with twelve poses to learn rigidity from.
    Gecko,
    /// A bar with joints, and twelve poses.
    JointedBar,
}

struct Parts {
    name: &'static str,
    glb: &'static [u8],
    handles: &'static str,
    rigidity: Option<&'static str>,
}

impl Sample {
    /// All, the start sample first.
    pub const ALL: [Sample; 7] = [
        Sample::Creature,
        Sample::Cactus,
        Sample::Sheet,
        Sample::Bar,
        Sample::ThinBar,
        Sample::Gecko,
        Sample::JointedBar,
    ];

    /// Name in menus.
    pub const fn name(self) -> &'static str {
        self.parts().name
    }

    const fn parts(self) -> Parts {
        macro_rules! asset {
            ($name:literal) => {
                concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/", $name)
            };
        }
        match self {
            Sample::Creature => Parts {
                name: "creature",
                glb: include_bytes!(asset!("creature.glb")),
                handles: include_str!(asset!("creature.handles.json")),
                rigidity: Some(include_str!(asset!("creature.rigidity.json"))),
            },
            Sample::Cactus => Parts {
                name: "cactus",
                glb: include_bytes!(asset!("cactus.glb")),
                handles: include_str!(asset!("cactus.handles.json")),
                rigidity: None,
            },
            Sample::Sheet => Parts {
                name: "sheet",
                glb: include_bytes!(asset!("sheet.glb")),
                handles: include_str!(asset!("sheet.handles.json")),
                rigidity: None,
            },
            Sample::Bar => Parts {
                name: "bar",
                glb: include_bytes!(asset!("bar.glb")),
                handles: include_str!(asset!("bar.handles.json")),
                rigidity: None,
            },
            Sample::ThinBar => Parts {
                name: "thin bar",
                glb: include_bytes!(asset!("thin-bar.glb")),
                handles: include_str!(asset!("thin-bar.handles.json")),
                rigidity: None,
            },
            Sample::Gecko => Parts {
                name: "gecko (12 poses)",
                glb: include_bytes!(asset!("gecko.glb")),
                handles: include_str!(asset!("gecko.handles.json")),
                rigidity: None,
            },
            Sample::JointedBar => Parts {
                name: "jointed bar (12 poses)",
                glb: include_bytes!(asset!("jointed-bar.glb")),
                handles: include_str!(asset!("jointed-bar.handles.json")),
                rigidity: None,
            },
        }
    }

    /// Reads it. The meshes are part of the program, so an error is a defect of the program.
    pub fn model(self) -> Result<Model, ModelError> {
        let parts = self.parts();
        let options = OpenOptions { keep: true, ..OpenOptions::default() };
        let mut file = options.from_bytes(parts.glb, Format::Glb, parts.name)?;
        if let Some(r) = parts.rigidity.and_then(|text| serde_json::from_str(text).ok()) {
            file.rigidity = Some(r);
        }
        let mut model = Model::from_file(file)?;
        model.name = parts.name.into();
        Ok(model)
    }

    /// Anchors what the sample's handle file holds in place. Not a step that can be undone: it is how the sample comes.
    pub fn prepare(self, document: &mut Document) {
        #[derive(serde::Deserialize)]
        struct Fixed {
            #[serde(default)]
            fixed: Vec<u32>,
        }
        let Ok(handles) = serde_json::from_str::<Fixed>(self.parts().handles) else {
            return;
        };
        let points = &document.model().file.weld.point_of_vertex;
        let vertices = handles.fixed.iter().filter_map(|&v| points.get(v as usize)).map(|&p| VertexId(p)).collect();
        if document.apply(Command::Hold { kind: GroupKind::Anchor, vertices }).is_ok() {
            document.forget_history();
        }
    }
}
