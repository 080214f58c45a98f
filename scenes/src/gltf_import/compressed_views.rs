//! Decodes buffer views that an extension compresses, in parallel. Errors name the view.

use std::collections::HashMap;

use rayon::prelude::*;

use super::{
    file::File,
    limits,
    meshopt::{Compressed, NAMES},
};
use crate::SceneError;

/// The decoded bytes of all compressed buffer views, keyed by their index.
pub(super) fn decode(file: &File) -> Result<HashMap<usize, Vec<u8>>, SceneError> {
    let views = file.root.buffer_views.iter().enumerate();
    let compressed = views.filter_map(|(ix, view)| {
        let extensions = &view.extensions.as_ref()?.others;
        NAMES.iter().find_map(|name| Some((ix, *name, extensions.get(*name)?)))
    });
    let parse = |(ix, name, json): (usize, &str, &serde_json::Value)| {
        let field = format!("bufferViews[{ix}].extensions.{name}");
        match serde_json::from_value::<Compressed>(json.clone()) {
            Ok(view) => Ok((ix, field, view)),
            Err(error) => {
                Err(file.invalid(field, json, format!("a valid compressed view: {error}")))
            }
        }
    };
    let compressed: Vec<_> = compressed.map(parse).collect::<Result<_, _>>()?;
    let together = compressed.iter().map(|(.., view)| view.size()).fold(0, u64::saturating_add);
    let most = limits::budget_bytes();
    if together > most {
        let accepted = format!("at most {most}, a quarter of the machine's memory");
        return Err(file.invalid("bytes of all compressed buffer views", together, accepted));
    }
    compressed
        .into_par_iter()
        .map(|(ix, field, view)| {
            let source = file.part(&field, view.buffer, view.byte_offset, view.byte_length)?;
            let bytes = view
                .decode(source)
                .map_err(|wanted| file.invalid(&field, "not decodable", wanted))?;
            let (found, promised) = (bytes.len() as u64, file.root.buffer_views[ix].byte_length.0);
            if found < promised {
                let accepted = format!("at most {found}, the decoded bytes");
                let field = format!("bufferViews[{ix}].byteLength");
                return Err(file.invalid(field, promised, accepted));
            }
            Ok((ix, bytes))
        })
        .collect()
}
