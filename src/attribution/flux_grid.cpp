#include "attribution/flux_grid.h"

#include <algorithm>
#include <map>

namespace heatsoak {

LatentFlux FluxGrid::at(const FluxPlace& place) const {
  LatentFlux flux;
  for (std::size_t f = 0; f < fluxes; ++f) {
    flux.rms_W.push_back(rms_W[static_cast<std::size_t>(place[f])]);
  }
  flux.time_scale_s = time_scale_s[static_cast<std::size_t>(place[fluxes])];
  return flux;
}

FluxPlace FluxGrid::middle() const {
  FluxPlace place(fluxes, static_cast<int>(rms_W.size()) / 2 - 1);
  place.push_back(static_cast<int>(time_scale_s.size()) / 2);
  return place;
}

std::vector<FluxPlace> FluxGrid::star(const FluxPlace& place) const {
  std::vector<FluxPlace> all{place};
  for (std::size_t axis = 0; axis <= fluxes; ++axis) {
    const auto count = static_cast<int>(axis < fluxes ? rms_W.size() : time_scale_s.size());
    for (const int step : {-1, 1}) {
      FluxPlace other = place;
      other[axis] += step;
      if (other[axis] >= 0 && other[axis] < count) {
        all.push_back(std::move(other));
      }
    }
  }
  return all;
}

FluxGrid flux_grid(double material_W, std::size_t fluxes) {
  FluxGrid grid;
  grid.fluxes = fluxes;
  for (const double share : {0.02, 0.12, 0.3, 0.7, 1.6, 3.6, 8.0}) {
    grid.rms_W.push_back(share * material_W);
  }
  grid.time_scale_s = {40.0, 130.0, 400.0, 1200.0};
  return grid;
}

FluxPlace most_probable(const FluxGrid& grid, FluxPlace start, const std::function<double(const FluxPlace&)>& nats) {
  std::map<FluxPlace, double> known;
  const auto at = [&](const FluxPlace& place) {
    const auto found = known.find(place);
    return found != known.end() ? found->second : known[place] = nats(place);
  };
  for (bool moved = true; moved;) {
    moved = false;
    for (const FluxPlace& other : grid.star(start)) {
      if (at(other) > at(start)) {
        start = other;
        moved = true;
      }
    }
  }
  return start;
}

}  // namespace heatsoak
