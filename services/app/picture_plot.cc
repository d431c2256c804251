#include <fmt/format.h>

#include <cmath>

#include "services/app/picture_marks.h"

namespace giveway::app {
namespace {

// 1, 2 or 5 times a power of ten metres, at least `least_px` wide.
double RoundStep(const Canvas& canvas, double least_px) {
  double decade = 0.1;
  while (true) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      if (canvas.Pixels(decade * factor) >= least_px) return decade * factor;
    }
    decade *= 10;
  }
}

// The first multiple of `step` at or above `low`.
double FirstMultiple(double step, double low) { return std::ceil(low / step) * step; }

}  // namespace

void DrawGrid(Canvas* canvas) {
  const auto& [low, high] = canvas->Shown();
  const double step = RoundStep(*canvas, 60);
  const Pixel from = canvas->TopLeft();
  const Pixel to = canvas->BottomRight();
  canvas->Rectangle(from, to.x - from.x, to.y - from.y, "fill=\"#fafbfc\" stroke=\"#d5d9de\"");
  // Counted, not added up: far from the origin a sum may stand still.
  const auto lines = [step](double first, double last) {
    return static_cast<int>(std::floor((last - first) / step)) + 1;
  };
  const auto style = [](double value) {
    return value == 0 ? "stroke=\"#c3c9d1\"" : "stroke=\"#e6e9ed\"";
  };
  const double first_x = FirstMultiple(step, low.x);
  for (int i = 0; i < lines(first_x, high.x); ++i) {
    const double value = first_x + i * step + 0.0;
    const double x = canvas->At({value, 0}).x;
    canvas->Line({x, from.y}, {x, to.y}, style(value));
    canvas->Text({x, to.y + 16}, fmt::format("{:g}", value), "class=\"axis middle\"");
  }
  const double first_y = FirstMultiple(step, low.y);
  for (int i = 0; i < lines(first_y, high.y); ++i) {
    const double value = first_y + i * step + 0.0;
    const double y = canvas->At({0, value}).y;
    canvas->Line({from.x, y}, {to.x, y}, style(value));
    canvas->Text({from.x - 8, y + 4}, fmt::format("{:g}", value), "class=\"axis end\"");
  }
}

void DrawScaleBar(Canvas* canvas) {
  const double metres = RoundStep(*canvas, 60);
  const Pixel right{canvas->BottomRight().x - 14, canvas->BottomRight().y - 14};
  const Pixel left{right.x - canvas->Pixels(metres), right.y};
  constexpr const char* kStyle = "stroke=\"#444\" stroke-width=\"2\"";
  canvas->Line(left, right, kStyle);
  canvas->Line({left.x, left.y - 4}, {left.x, left.y + 4}, kStyle);
  canvas->Line({right.x, right.y - 4}, {right.x, right.y + 4}, kStyle);
  canvas->Text({(left.x + right.x) / 2, right.y - 7}, fmt::format("{:g} m", metres),
               "class=\"time middle\" style=\"font-size:11px\"");
}

}  // namespace giveway::app
