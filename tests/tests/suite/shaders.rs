//! Shaders, without a GPU.

use naga::valid::{Capabilities, ValidationFlags, Validator};

#[test]
fn every_shader_is_valid_without_optional_capabilities() {
    for (name, text) in pliant::viewport::SHADERS {
        let module = naga::front::wgsl::parse_str(text)
            .unwrap_or_else(|error| panic!("{}", error.emit_to_string_with_path(text, name)));
        let checked = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module);
        if let Err(error) = checked {
            panic!("{}", error.emit_to_string_with_path(text, name));
        }
    }
}
