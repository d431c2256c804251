#include "tests/bench/baseline/detour.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "services/types/math/math.h"

namespace giveway::bench {
namespace {

constexpr std::size_t kMostDiscs = 24;
constexpr double kTouch_m = 1e-6;

// What the string runs round. The offset is the radius, positive where the centre is on the left;
// zero at either end.
struct Peg {
  Vec2 centre;
  double offset = 0;
  std::size_t disc = 0;  // index of it; nonsense at the ends
};

// The straight piece from one peg to the next.
struct Piece {
  Vec2 from;
  Vec2 direction;
  double length_m = 0;
};

// Touches both: the centres' distance across the direction is the difference of the offsets.
std::optional<Piece> Tangent(const Peg& a, const Peg& b) {
  const Vec2 apart = b.centre - a.centre;
  const double length = Norm(apart);
  if (length <= 0) return std::nullopt;
  const double sine = -(b.offset - a.offset) / length;
  if (sine <= -1 || sine >= 1) return std::nullopt;
  const double cosine = Sqrt(1 - sine * sine);
  const Vec2 unit = 1 / length * apart;
  const Vec2 direction = cosine * unit + sine * Left(unit);
  return Piece{a.centre - a.offset * Left(direction), direction, length * cosine};
}

// How deep the piece runs into the disc, and where.
struct Cut {
  double depth_m;
  double at_m;
};

Cut CutOf(const Piece& piece, const Standing& disc) {
  const double at_m =
      std::clamp(Dot(disc.centre_world - piece.from, piece.direction), 0.0, piece.length_m);
  const Vec2 nearest = piece.from + at_m * piece.direction;
  return {disc.radius_m - Norm(disc.centre_world - nearest), at_m};
}

class String {
 public:
  String(Vec2 from, Vec2 to, std::span<const Standing> discs) : discs_(discs) {
    pegs_ = {{.centre = from}, {.centre = to}};
  }

  // False if it cannot be pulled tight.
  bool Pull() {
    for (std::size_t turn = 0; turn < 2 * kMostDiscs; ++turn) {
      if (!Draw()) return false;
      if (LetGo()) continue;
      if (!CatchOnDisc()) return true;
    }
    return false;
  }

  ArcPath AsPath(double beyond_m) const {
    const Vec2 first = pieces_.front().direction;
    ArcPath path({pieces_.front().from, Atan2(first.y, first.x)});
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (i > 0) {
        const double offset = pegs_[i].offset;
        path.Add(TurnAt(i) * offset, 1 / offset);
      }
      const bool last = i + 1 == pieces_.size();
      path.Add(pieces_[i].length_m + (last ? beyond_m : 0), 0);
    }
    return path;
  }

 private:
  bool Draw() {
    pieces_.clear();
    for (std::size_t i = 0; i + 1 < pegs_.size(); ++i) {
      const std::optional<Piece> piece = Tangent(pegs_[i], pegs_[i + 1]);
      if (!piece) return false;
      pieces_.push_back(*piece);
    }
    return true;
  }

  // Counter-clockwise, between the pieces before and after the peg.
  double TurnAt(std::size_t peg) const {
    const Vec2 in = pieces_[peg - 1].direction;
    const Vec2 out = pieces_[peg].direction;
    return Atan2(Cross(in, out), Dot(in, out));
  }

  // A peg the string would have to be pushed round is none.
  bool LetGo() {
    for (std::size_t i = 1; i + 1 < pegs_.size(); ++i) {
      if (TurnAt(i) * pegs_[i].offset >= 0) continue;
      pegs_.erase(pegs_.begin() + static_cast<std::ptrdiff_t>(i));
      return true;
    }
    return false;
  }

  bool IsPeg(std::size_t disc) const {
    return std::any_of(pegs_.begin() + 1, pegs_.end() - 1,
                       [&](const Peg& peg) { return peg.disc == disc; });
  }

  // The first disc a piece runs into becomes a peg, on the side that is nearer.
  bool CatchOnDisc() {
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      std::optional<std::size_t> first;
      double first_at_m = 0;
      for (std::size_t disc = 0; disc < discs_.size(); ++disc) {
        const Cut cut = CutOf(pieces_[i], discs_[disc]);
        if (cut.depth_m < kTouch_m || IsPeg(disc)) continue;
        if (first && cut.at_m >= first_at_m) continue;
        first = disc;
        first_at_m = cut.at_m;
      }
      if (!first) continue;
      const Standing& disc = discs_[*first];
      const double side = Cross(pieces_[i].direction, disc.centre_world - pieces_[i].from);
      pegs_.insert(pegs_.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                   {disc.centre_world, side > 0 ? disc.radius_m : -disc.radius_m, *first});
      return true;
    }
    return false;
  }

  std::span<const Standing> discs_;
  std::vector<Peg> pegs_;
  std::vector<Piece> pieces_;
};

}  // namespace

std::optional<ArcPath> PathAround(Vec2 from_world, Vec2 to_world, std::span<const Standing> discs,
                                  double beyond_m) {
  String string(from_world, to_world, discs);
  if (!string.Pull()) return std::nullopt;
  return string.AsPath(beyond_m);
}

}  // namespace giveway::bench
