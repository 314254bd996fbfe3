//! Icons of the tools, drawn with a few strokes so that they are crisp at any pixel density.

use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, pos2};

use crate::tools::ToolKind;

/// Paints the icon of a tool into a square.
pub(super) fn paint(painter: &Painter, rect: Rect, tool: ToolKind, color: Color32) {
    let at = |x: f32, y: f32| pos2(rect.left() + x * rect.width(), rect.top() + y * rect.height());
    let stroke = Stroke::new((rect.width() * 0.085).max(1.2), color);
    let line = |points: &[(f32, f32)]| {
        let points: Vec<Pos2> = points.iter().map(|&(x, y)| at(x, y)).collect();
        painter.add(Shape::line(points, stroke));
    };
    match tool {
        ToolKind::Handle => {
            line(&[(0.08, 0.85), (0.30, 0.80), (0.50, 0.62), (0.62, 0.42)]);
            painter.circle_filled(at(0.70, 0.30), rect.width() * 0.17, color);
        }
        ToolKind::Anchor => {
            painter.circle_stroke(at(0.5, 0.17), rect.width() * 0.10, stroke);
            line(&[(0.5, 0.27), (0.5, 0.90)]);
            line(&[(0.30, 0.42), (0.70, 0.42)]);
            line(&[(0.12, 0.60), (0.20, 0.78), (0.34, 0.88), (0.5, 0.91), (0.66, 0.88), (0.80, 0.78), (0.88, 0.60)]);
        }
        ToolKind::Select => {
            let corners =
                [(0.10, 0.10, 1.0, 1.0), (0.90, 0.10, -1.0, 1.0), (0.10, 0.90, 1.0, -1.0), (0.90, 0.90, -1.0, -1.0)];
            for (x, y, dx, dy) in corners {
                line(&[(x + 0.22 * dx, y), (x, y), (x, y + 0.22 * dy)]);
            }
            for (x, y) in [(0.36, 0.40), (0.62, 0.36), (0.52, 0.64)] {
                painter.circle_filled(at(x, y), rect.width() * 0.075, color);
            }
        }
        ToolKind::Brush => {
            line(&[(0.92, 0.08), (0.50, 0.52)]);
            let tip =
                [(0.40, 0.50), (0.55, 0.64), (0.46, 0.82), (0.24, 0.92), (0.08, 0.92), (0.18, 0.80), (0.22, 0.62)];
            let tip = tip.iter().map(|&(x, y)| at(x, y)).collect();
            painter.add(Shape::convex_polygon(tip, color, Stroke::NONE));
        }
        ToolKind::Inspect => {
            painter.circle_stroke(at(0.42, 0.42), rect.width() * 0.30, stroke);
            line(&[(0.64, 0.64), (0.92, 0.92)]);
            painter.circle_filled(at(0.42, 0.42), rect.width() * 0.085, color);
        }
        ToolKind::Fill => {
            line(&[(0.44, 0.12), (0.80, 0.48), (0.44, 0.84), (0.08, 0.48), (0.44, 0.12)]);
            let paint = [(0.12, 0.50), (0.76, 0.50), (0.44, 0.82)].map(|(x, y)| at(x, y));
            painter.add(Shape::convex_polygon(paint.to_vec(), color, Stroke::NONE));
            painter.circle_filled(at(0.90, 0.76), rect.width() * 0.085, color);
            line(&[(0.90, 0.60), (0.90, 0.76)]);
        }
    }
}
