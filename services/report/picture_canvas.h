// Where world metres become SVG pixels: elements, escaping, and labels that do not overlap. Knows
// nothing of vehicles. An element with a number that is not finite is left out.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "services/types/math/vec2.h"

namespace giveway {

// Screen coordinates: x right, y down.
struct Pixel {
  double x = 0;
  double y = 0;
};
double Distance(Pixel a, Pixel b);

// A part of the world that a picture shows, metres. Empty until it includes a point.
struct WorldBox {
  Vec2 low{1, 1};
  Vec2 high{-1, -1};
  bool Empty() const { return high.x < low.x; }
  // Grows to hold a disc; one that is not finite is ignored.
  void Include(Vec2 centre_world, double radius_m);
};

class Canvas {
 public:
  // Shows at least `box` in a plot below a header and above a footer of these heights.
  Canvas(const WorldBox& box, double header_px, double footer_px);

  Pixel At(Vec2 point_world) const;
  double Pixels(double metres) const { return metres * pixels_per_m_; }
  const WorldBox& Shown() const { return shown_; }
  // The plot on the screen and the width of the whole picture.
  Pixel TopLeft() const { return top_left_; }
  Pixel BottomRight() const { return bottom_right_; }
  double Width() const { return bottom_right_.x + top_left_.x; }

  void Line(Pixel from, Pixel to, std::string_view attributes);
  void Circle(Pixel centre, double radius_px, std::string_view attributes);
  void Rectangle(Pixel corner, double width_px, double height_px, std::string_view attributes);
  void Path(const std::vector<Pixel>& points, std::string_view attributes);
  // `text` may hold anything; it is escaped here.
  void Text(Pixel at, std::string_view text, std::string_view attributes);

  // Labels keep off these points; in a picture so full that they are many, off the first of them.
  void KeepClear(Pixel point) {
    if (busy_.size() < kMaxBusy) busy_.push_back(point);
  }
  // Writes `text` at the freest place around a disc; nothing once there are more than anyone reads.
  void Label(Pixel centre, double radius_px, std::string_view text, std::string_view attributes);

  std::string Svg(std::string_view title) const;

 private:
  static constexpr std::size_t kMaxBusy = 20000;
  static constexpr std::size_t kMaxLabels = 300;

  struct LabelBox {
    Pixel centre;
    double half_width = 0;
    bool Holds(Pixel point) const;
    bool Meets(const LabelBox& other) const;
  };
  double Crowding(const LabelBox& box) const;

  WorldBox shown_;
  double pixels_per_m_ = 1;
  Pixel top_left_;
  Pixel bottom_right_;
  double footer_px_ = 0;
  std::vector<Pixel> busy_;
  std::vector<LabelBox> labels_;
  std::string elements_;
};

}  // namespace giveway
