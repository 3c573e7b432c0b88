//! Description of a job's map tiles for map programs: a capabilities document of the Web Map Tile Service (OGC 07-057r7), with which they find
//! the tiles and their places.

use maud::{Markup, PreEscaped, html};

/// Coordinates of the tiles, in the words of the standard's annex E.4.
const TILE_SET: &str = "GoogleMapsCompatible";
/// Scale denominator of the tile that shows the whole earth (OGC 07-057r7, table E.4).
const WHOLE_EARTH_SCALE: f64 = 559_082_264.028_717_8;
/// West and north end of the map in the projection's meters: half of the equator.
const TOP_LEFT_M: &str = "-20037508.3427892 20037508.3427892";

/// A job's map.
#[derive(Debug, Clone, Copy)]
pub struct JobMap<'a> {
    /// The server's address as the client entered it, such as `http://127.0.0.1:8080`.
    pub server: &'a str,
    /// Name of the job.
    pub name: &'a str,
    /// Title of the job.
    pub title: &'a str,
    /// Edge length of a tile, pixels.
    pub tile_px: u32,
    /// Highest zoom level.
    pub max_zoom: u8,
}

/// Renders the document.
#[must_use]
pub fn capabilities(map: &JobMap<'_>) -> Markup {
    html! {
        (PreEscaped("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"))
        Capabilities xmlns="http://www.opengis.net/wmts/1.0" xmlns:ows="http://www.opengis.net/ows/1.1" version="1.0.0" {
            ows:ServiceIdentification {
                ows:Title { "Spandrel" }
                ows:ServiceType { "OGC WMTS" }
                ows:ServiceTypeVersion { "1.0.0" }
            }
            Contents {
                (layer(map))
                (tile_set(map))
            }
        }
    }
}

fn layer(map: &JobMap<'_>) -> Markup {
    let template = format!("{}/tiles/{}/{{TileMatrix}}/{{TileCol}}/{{TileRow}}.png", map.server, map.name);
    html! {
        Layer {
            ows:Title { (map.title) }
            ows:WGS84BoundingBox {
                ows:LowerCorner { "-180 -85.0511287798" }
                ows:UpperCorner { "180 85.0511287798" }
            }
            ows:Identifier { (map.name) }
            Style isDefault="true" { ows:Identifier { "default" } }
            Format { "image/png" }
            TileMatrixSetLink { TileMatrixSet { (TILE_SET) } }
            ResourceURL format="image/png" resourceType="tile" template=(template) {}
        }
    }
}

fn tile_set(map: &JobMap<'_>) -> Markup {
    html! {
        TileMatrixSet {
            ows:Identifier { (TILE_SET) }
            ows:SupportedCRS { "urn:ogc:def:crs:EPSG::3857" }
            WellKnownScaleSet { "urn:ogc:def:wkss:OGC:1.0:" (TILE_SET) }
            @for zoom in 0..=map.max_zoom {
                @let tiles = 1_u32 << zoom;
                TileMatrix {
                    ows:Identifier { (zoom) }
                    ScaleDenominator { (WHOLE_EARTH_SCALE / f64::from(tiles)) }
                    TopLeftCorner { (TOP_LEFT_M) }
                    TileWidth { (map.tile_px) }
                    TileHeight { (map.tile_px) }
                    MatrixWidth { (tiles) }
                    MatrixHeight { (tiles) }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_document_names_every_zoom_level_and_escapes_titles() {
        let map = JobMap { server: "http://localhost:8080", name: "my-job", title: "A <b> & \"c\"", tile_px: 256, max_zoom: 22 };
        let text = capabilities(&map).into_string();
        assert!(text.contains("template=\"http://localhost:8080/tiles/my-job/{TileMatrix}/{TileCol}/{TileRow}.png\""), "{text}");
        assert!(text.contains("A &lt;b&gt; &amp; &quot;c&quot;"), "{text}");
        assert_eq!(text.matches("<TileMatrix>").count(), 23);
        assert!(text.contains("<ows:Identifier>22</ows:Identifier><ScaleDenominator>133.29559899"), "{text}");
        assert!(text.contains("<MatrixWidth>4194304</MatrixWidth>"), "{text}");
    }
}
