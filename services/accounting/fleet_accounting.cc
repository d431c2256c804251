#include "services/accounting/fleet_accounting.h"

#include <algorithm>
#include <cstdlib>

namespace giveway {
namespace {

std::uint64_t Differing(std::int64_t difference) {
  return static_cast<std::uint64_t>(std::abs(difference));
}

}  // namespace

void FleetAccounting::Add(const BeaconAccount& account, PairAccount* to) {
  to->sums += account;
  to->differing += Differing(account.Difference());
}

void FleetAccounting::Fold(const VehicleStatus& status) {
  ++reports_;
  const std::uint64_t departed = Differing(status.departed.Difference());
  if (departed != 0) departed_[status.vehicle] = departed;
  const bool has_account = !status.accounts.Rows().empty() || status.departed.writers > 0;
  if (has_account || status.beacons.accepted > 0) {
    accepts_[status.vehicle] = accepts_[status.vehicle] || has_account;
  }
  for (const BeaconAccount& account : status.accounts.Rows()) {
    const std::pair names{status.vehicle, account.writer};
    if (!pairs_.contains(names) && !HasRoomFor(account)) continue;
    Take(account, &pairs_[names]);
  }
}

bool FleetAccounting::HasRoomFor(const BeaconAccount& account) const {
  return pairs_.size() < (account.Difference() == 0 ? kMostPairs : 2 * kMostPairs);
}

// The same life of the writer, and one life of the reader, have the same first number.
void FleetAccounting::Take(const BeaconAccount& account, Pair* pair) const {
  const auto same = std::ranges::find_if(pair->open, [&account](const Open& open) {
    return open.newest.boot_epoch == account.boot_epoch && open.newest.first == account.first;
  });
  if (same != pair->open.end()) {
    if (account.last < same->newest.last) Add(same->newest, &pair->closed);
    *same = {account, reports_};
    return;
  }
  if (pair->open.size() == kMostOpen) {
    const auto oldest = std::ranges::min_element(pair->open, {}, &Open::reported);
    Add(oldest->newest, &pair->closed);
    pair->open.erase(oldest);
  }
  pair->open.push_back({account, reports_});
}

std::vector<VehicleId> FleetAccounting::WithoutAccount() const {
  std::vector<VehicleId> readers;
  for (const auto& [reader, has_account] : accepts_) {
    if (!has_account) readers.push_back(reader);
  }
  return readers;
}

std::vector<PairAccount> FleetAccounting::Pairs() const {
  std::vector<PairAccount> all;
  for (const auto& [names, pair] : pairs_) {
    PairAccount& account = all.emplace_back(pair.closed);
    account.reader = names.first;
    account.writer = names.second;
    for (const Open& open : pair.open) Add(open.newest, &account);
  }
  return all;
}

}  // namespace giveway
