#include "services/report/picture_canvas.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "services/runtime/utf8.h"

namespace giveway {
namespace {

constexpr double kPlotWidth = 880;
constexpr double kPlotHeight = 620;
constexpr double kEdge = 44;        // space for the numbers next to the plot
constexpr double kLabelHalf = 9;    // half the height of a label
constexpr double kCharacter = 7.2;  // width of a character of a label

bool Finite(Pixel p) { return std::isfinite(p.x) && std::isfinite(p.y); }

std::string Escape(std::string_view text) {
  std::string escaped;
  for (const char c : WellFormed(text)) {
    if (static_cast<unsigned char>(c) < 0x20) {
      escaped += ' ';  // XML allows no control characters
    } else if (c == '<') {
      escaped += "&lt;";
    } else if (c == '>') {
      escaped += "&gt;";
    } else if (c == '&') {
      escaped += "&amp;";
    } else if (c == '"') {
      escaped += "&quot;";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

// At least 4 m, and no side shorter than 0.4 of the other: a line still makes a picture.
WorldBox Roomy(WorldBox box) {
  if (box.Empty()) box = {{-2, -2}, {2, 2}};
  const double width = box.high.x - box.low.x;
  const double height = box.high.y - box.low.y;
  const double more_x = std::max({0.0, 4 - width, 0.4 * height - width}) / 2;
  const double more_y = std::max({0.0, 4 - height, 0.4 * width - height}) / 2;
  const double margin = 0.04 * std::max(width, height) + 0.1;
  const Vec2 more{more_x + margin, more_y + margin};
  return {box.low - more, box.high + more};
}

constexpr std::string_view kStyle =
    "text{font-family:'DejaVu Sans',Helvetica,Arial,sans-serif;font-size:12px;fill:#333}"
    ".label{font-weight:600;paint-order:stroke;stroke:#fff;stroke-width:4px;stroke-linejoin:round}"
    ".time{font-size:9.5px;fill:#666;paint-order:stroke;stroke:#fff;stroke-width:3px;"
    "stroke-linejoin:round}"
    ".axis{font-size:10.5px;fill:#888}.title{font-size:20px;font-weight:600;fill:#222}"
    ".quiet{fill:#666}.end{text-anchor:end}.middle{text-anchor:middle}";

}  // namespace

double Distance(Pixel a, Pixel b) { return std::hypot(a.x - b.x, a.y - b.y); }

void WorldBox::Include(Vec2 centre_world, double radius_m) {
  if (!std::isfinite(centre_world.x + centre_world.y + radius_m)) return;
  const Vec2 radius{radius_m, radius_m};
  const Vec2 from = centre_world - radius;
  const Vec2 to = centre_world + radius;
  if (Empty()) {
    low = from;
    high = to;
    return;
  }
  low = {std::min(low.x, from.x), std::min(low.y, from.y)};
  high = {std::max(high.x, to.x), std::max(high.y, to.y)};
}

Canvas::Canvas(const WorldBox& box, double header_px, double footer_px)
    : shown_(Roomy(box)), top_left_{kEdge, header_px}, footer_px_(footer_px) {
  const Vec2 size = shown_.high - shown_.low;
  pixels_per_m_ = std::min(kPlotWidth / size.x, kPlotHeight / size.y);
  // The header needs the whole width: a narrow world shows more to its sides.
  const double more_m = (kPlotWidth / pixels_per_m_ - size.x) / 2;
  shown_.low.x -= more_m;
  shown_.high.x += more_m;
  bottom_right_ = {kEdge + kPlotWidth, header_px + Pixels(size.y)};
}

Pixel Canvas::At(Vec2 point_world) const {
  return {top_left_.x + Pixels(point_world.x - shown_.low.x),
          bottom_right_.y - Pixels(point_world.y - shown_.low.y)};
}

void Canvas::Line(Pixel from, Pixel to, std::string_view attributes) {
  if (!Finite(from) || !Finite(to)) return;
  elements_ += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n",
                           from.x, from.y, to.x, to.y, attributes);
}

void Canvas::Circle(Pixel centre, double radius_px, std::string_view attributes) {
  if (!Finite(centre) || !std::isfinite(radius_px)) return;
  elements_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" {}/>\n", centre.x,
                           centre.y, std::max(radius_px, 2.0), attributes);
}

void Canvas::Rectangle(Pixel corner, double width_px, double height_px,
                       std::string_view attributes) {
  elements_ +=
      fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" {}/>\n",
                  corner.x, corner.y, width_px, height_px, attributes);
}

void Canvas::Path(const std::vector<Pixel>& points, std::string_view attributes) {
  std::string data;
  for (const Pixel& p : points) {
    if (Finite(p)) data += fmt::format("{}{:.1f} {:.1f}", data.empty() ? "M" : "L", p.x, p.y);
  }
  if (!data.empty()) elements_ += fmt::format("<path d=\"{}\" {}/>\n", data, attributes);
}

void Canvas::Text(Pixel at, std::string_view text, std::string_view attributes) {
  if (!Finite(at)) return;
  elements_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", at.x, at.y, attributes,
                           Escape(text));
}

bool Canvas::LabelBox::Holds(Pixel point) const {
  return std::abs(point.x - centre.x) <= half_width && std::abs(point.y - centre.y) <= kLabelHalf;
}

bool Canvas::LabelBox::Meets(const LabelBox& other) const {
  return std::abs(centre.x - other.centre.x) <= half_width + other.half_width &&
         std::abs(centre.y - other.centre.y) <= 2 * kLabelHalf;
}

double Canvas::Crowding(const LabelBox& box) const {
  double crowding = 0;
  for (const Pixel& point : busy_) crowding += box.Holds(point) ? 1 : 0;
  for (const LabelBox& label : labels_) crowding += box.Meets(label) ? 100 : 0;
  const bool outside = box.centre.x - box.half_width < top_left_.x ||
                       box.centre.x + box.half_width > bottom_right_.x ||
                       box.centre.y - kLabelHalf < top_left_.y ||
                       box.centre.y + kLabelHalf > bottom_right_.y;
  return crowding + (outside ? 1000 : 0);
}

void Canvas::Label(Pixel centre, double radius_px, std::string_view text,
                   std::string_view attributes) {
  if (!Finite(centre) || !std::isfinite(radius_px) || labels_.size() >= kMaxLabels) return;
  const double half = kCharacter * static_cast<double>(text.size()) / 2;
  constexpr std::array<Pixel, 8> kDirections{
      {{1, 0}, {-1, 0}, {1, -1}, {-1, -1}, {1, 1}, {-1, 1}, {0, -1}, {0, 1}}};
  LabelBox best;
  double least = -1;
  for (const double away : {4.0, 20.0, 40.0}) {
    for (const Pixel& d : kDirections) {
      const double reach = (d.x != 0 && d.y != 0 ? 0.7 : 1) * radius_px + away;
      const LabelBox box{{centre.x + d.x * (reach + half), centre.y + d.y * (reach + kLabelHalf)},
                         half};
      const double crowding = Crowding(box) + away / 100;
      if (least >= 0 && crowding >= least) continue;
      least = crowding;
      best = box;
    }
  }
  labels_.push_back(best);
  Text({best.centre.x, best.centre.y + 4}, text,
       fmt::format("class=\"label middle\" {}", attributes));
}

std::string Canvas::Svg(std::string_view title) const {
  const double width = Width();
  const double height = bottom_right_.y + footer_px_;
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\" role=\"img\">\n<title>{2}</title>\n<style>{3}</style>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{4}</svg>\n",
      width, height, Escape(title), kStyle, elements_);
}

}  // namespace giveway
