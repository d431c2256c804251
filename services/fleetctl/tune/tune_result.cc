#include "services/fleetctl/tune/tune_result.h"

#include "services/fleetctl/tune/tune_front.h"

namespace giveway::fleetctl {

void ChooseRecommended(TuneResult* result) {
  std::vector<TuneFigures> figures;
  std::vector<std::size_t> places;  // of `figures` among the candidates
  for (std::size_t i = 0; i < result->candidates.size(); ++i) {
    if (!result->candidates[i].figures) continue;
    figures.push_back(*result->candidates[i].figures);
    places.push_back(i);
  }
  result->front.clear();
  result->recommended = 0;
  if (places.empty() || places.front() != 0) return;  // nothing to compare them with
  for (const std::size_t i : ParetoFront(figures)) {
    result->front.push_back(places[i]);
    result->candidates[places[i]].on_front = true;
  }
  result->recommended = places[Recommended(figures, 0)];
}

}  // namespace giveway::fleetctl
