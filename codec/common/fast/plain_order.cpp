#include "codec/common/fast/plain_order.h"

#include <algorithm>
#include <bit>

namespace reeb {

namespace {

constexpr uint32_t kSymbolClasses = 10;
constexpr int32_t kFirstCost = 8 * 512;
constexpr uint32_t kCostOfNone = 12 * 512;

using Reals = float __attribute__((vector_size(16)));

}  // namespace

IndexGuesser::IndexGuesser(const MeshWalk& walk)
    : walk_(walk), taken_(size_t{walk.turns()} + 1), index_(size_t{walk.turns()} + 1) {
  taken_.back() = 1;
  cost_.fill(Whole{} + kFirstCost);
}

// What follows goes without branches on what the mesh looks like: they are hard to foresee.
void IndexGuesser::start(uint32_t turn) {
  turn_ = turn;
  int32_t tips[kTips + 1] = {-1, -1, -1};
  int32_t latest[kNeighbours] = {-1, -1, -1, -1};  // turns, descending
  uint32_t count = 0;
  for (const auto& [a, b, across] : walk_.triangles(turn)) {
    const bool there = across != kNoTurn;
    tips[count] = there ? index_[a] + index_[b] - index_[across] : -1;
    count += there && count < kTips ? 1 : 0;
    insert(static_cast<int32_t>(a), latest);
    insert(static_cast<int32_t>(b), latest);
  }
  int32_t near[kNeighbours];
  for (uint32_t i = 0; i < kNeighbours; ++i)
    near[i] = latest[i] < 0 ? -2 : index_[static_cast<size_t>(latest[i])];
  order_guesses(0, Whole{tips[0], tips[1], turn > 0 ? index_[turn - 1] + 1 : -1, -1});
  const Whole indices = {near[0], near[1], near[2], near[3]};
  order_guesses(1, indices + 1);
  order_guesses(2, indices - 1);
  first_ = first_of(order_);
}

void IndexGuesser::insert(int32_t turn, int32_t (&latest)[kNeighbours]) {
  for (int32_t& l : latest) {
    const int32_t later = std::max(l, turn);
    turn = l == turn ? -1 : std::min(l, turn);
    l = later;
  }
}

void IndexGuesser::order_guesses(uint32_t part, const Whole& guesses) {
  const auto none = static_cast<int32_t>(walk_.turns());
  const Whole kinds = Whole{0, 1, 2, 3} + 4 * static_cast<int32_t>(part);
  const Whole there = (guesses >= 0) & (guesses < none);
  const Whole guess = there != 0 ? guesses : Whole{} + none;
  guess_[part] = guess;
  Whole taken{};
  for (uint32_t i = 0; i < 4; ++i) taken[i] = taken_[static_cast<size_t>(guess_[part][i])];
  order_[part] = taken != 0 ? Whole{} + kLast : cost_[part] * 16 + kinds;
}

uint32_t IndexGuesser::first_of(const Wholes& order) {
  Whole least = order[0] < order[1] ? order[0] : order[1];
  least = least < order[2] ? least : order[2];
  const int32_t first = std::min(std::min(least[0], least[1]), std::min(least[2], least[3]));
  return first == kLast ? kKinds : static_cast<uint32_t>(first) % 16;
}

uint32_t IndexGuesser::symbol_class() const {
  const auto size = static_cast<uint32_t>(at(cost_, first_)) >> 9;
  return std::min(size, kSymbolClasses - 1);
}

uint32_t IndexGuesser::difference_class() const {
  const uint32_t cost = empty() ? kCostOfNone : static_cast<uint32_t>(at(cost_, first_));
  return kSymbolClasses + std::min(cost * 3 >> 11, kRansClasses - kSymbolClasses - 1);
}

uint32_t IndexGuesser::likely() const {
  if (!empty()) return static_cast<uint32_t>(at(guess_, first_));
  return turn_ > 0 ? static_cast<uint32_t>(index_[turn_ - 1]) + 1 : 0;
}

uint32_t IndexGuesser::symbol_of(uint32_t index) const {
  for (uint32_t symbol = 0, guess = 0; find(symbol, guess); symbol += symbol == 0 ? 2 : 1) {
    if (guess == index) return symbol;
  }
  return kNone;
}

bool IndexGuesser::find(uint32_t symbol, uint32_t& index) const {
  if (symbol == 0) {
    index = static_cast<uint32_t>(at(guess_, first_));
    return true;
  }
  Wholes order = order_;
  uint32_t kind = first_;
  for (uint32_t place = 1; place < symbol && kind != kKinds; ++place) {
    for (uint32_t i = 0; i < order.size(); ++i)
      order[i] = guess_[i] == at(guess_, kind) ? Whole{} + kLast : order[i];
    kind = first_of(order);
  }
  if (kind == kKinds) return false;
  index = static_cast<uint32_t>(at(guess_, kind));
  return true;
}

void IndexGuesser::note(uint32_t index) {
  constexpr int32_t kMaxMissed = 1 << 20;
  for (uint32_t i = 0; i < order_.size(); ++i) {
    const Whole difference = guess_[i] - static_cast<int32_t>(index);
    const Whole distance = difference < 0 ? -difference : difference;
    const Whole missed = distance < kMaxMissed ? distance : Whole{} + kMaxMissed;
    // The exponent and five bits of the fraction.
    const Reals size = __builtin_convertvector(missed + 1, Reals);
    const Whole log2 = (reinterpret_cast<Whole>(size) >> 18) - 127 * 32;
    const Whole change = (16 * log2 - cost_[i]) >> 4;
    cost_[i] += order_[i] == kLast ? Whole{} : change;
  }
  taken_[index] = 1;
  index_[turn_] = static_cast<int32_t>(index);
}

}  // namespace reeb
