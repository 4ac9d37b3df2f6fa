#include "codec/dec/connectivity/connectivity_decoder.h"

#include <algorithm>

#include "bitstream/bytes.h"
#include "codec/dec/connectivity/surface_builder.h"
#include "codec/dec/connectivity/symbol_reader.h"
#include "entropy/raw_bits.h"

namespace reeb {
namespace {

constexpr uint64_t kMaxTriangles = 1u << 29;  // whose corners are below 2^32

struct SectionHeader {
  uint8_t traversal = 0, attribute_tables = 0;
  uint64_t vertices = 0, triangles = 0, symbols = 0, splits = 0;
};

SectionHeader read_section_header(ByteReader& in) {
  SectionHeader h;
  h.traversal = in.u8();
  h.vertices = in.varuint();
  h.triangles = in.varuint();
  h.attribute_tables = in.u8();
  h.symbols = in.varuint();
  h.splits = in.varuint();
  return h;
}

Status check_section_header(const SectionHeader& h, const Limits& limits, uint64_t max_triangles) {
  if (h.traversal != 0 && h.traversal != 2)
    return Status::corrupt("connectivity: unknown traversal");
  // Every symbol makes three points at most, one in three is followed by a triangle without symbol.
  const bool possible = h.attribute_tables == 0 && h.triangles > 0 && h.vertices > 0 &&
                        h.triangles <= kMaxTriangles && h.symbols <= h.triangles &&
                        h.triangles <= h.symbols + h.symbols / 3 && h.splits <= h.symbols &&
                        h.vertices <= 3 * h.symbols - h.splits;
  if (!possible) return Status::corrupt("connectivity: its counts are impossible");
  if (h.triangles > 4 * uint64_t{limits.max_faces} ||
      h.vertices > 4 * uint64_t{limits.max_vertices} ||
      h.triangles > limits.max_memory / kConnectivityMemoryPerTriangle) {
    return Status::limit("connectivity: more triangles or vertices than allowed");
  }
  if (h.triangles > max_triangles)
    return Status::corrupt("connectivity: more triangles than its bytes can hold");
  return {};
}

/// An edge that waits for the split that joins it to what is active then. Symbols are counted in
/// the order of decoding.
struct WaitingEdge {
  uint32_t split = 0, edge = 0;
};

/// Waiting edges in the order of their splits; false where they are malformed. The section counts
/// symbols from the last one. That an edge is free is found out when it is taken.
bool read_waiting_edges(ByteReader& in, uint32_t symbol_count, uint64_t most,
                        std::vector<WaitingEdge>& out) {
  const uint64_t count = in.varuint();
  if (!in.ok() || count > most) return false;
  uint64_t source = 0;
  for (uint64_t i = 0; i < count; ++i) {
    source += in.varuint();
    const uint64_t distance = in.varuint();
    if (!in.ok() || source >= symbol_count || distance == 0 || distance > source) return false;
    const auto triangle = static_cast<uint32_t>(symbol_count - 1 - source);
    out.push_back({.split = triangle + static_cast<uint32_t>(distance), .edge = 3 * triangle});
  }
  RawBitReader right(in.take((count + 7) / 8));
  for (WaitingEdge& e : out) e.edge += right.code(0, 1) != 0 ? 1 : 2;
  std::sort(out.begin(), out.end(),
            [](const WaitingEdge& a, const WaitingEdge& b) { return a.split < b.split; });
  return in.ok() && right.at_end();
}

/// Builds the surface that symbols tell.
class Edgebreaker {
 public:
  Edgebreaker(const SectionHeader& h, SymbolReader& symbols, std::span<const WaitingEdge> waiting)
      : h_(h),
        symbols_(symbols),
        waiting_(waiting),
        surface_(static_cast<uint32_t>(h.triangles), static_cast<uint32_t>(h.vertices + h.splits)) {
  }

  bool decode() {
    return add_triangles() && finish_components() && symbols_.at_end() && waiting_.empty() &&
           surface_.triangle_count() == h_.triangles && surface_.joined_count() == h_.splits &&
           surface_.point_count() == h_.vertices;
  }

  std::vector<uint32_t> take_triangles() { return surface_.take_triangles(); }

 private:
  bool add_triangles();
  uint32_t add_triangle(uint32_t i, Symbol symbol);
  uint32_t add_split(uint32_t i);
  bool finish_components();
  uint32_t pop_active();

  const SectionHeader& h_;
  SymbolReader& symbols_;
  std::span<const WaitingEdge> waiting_;
  SurfaceBuilder surface_;
  std::vector<uint32_t> active_;  ///< edges, the latest last
};

bool Edgebreaker::add_triangles() {
  for (uint32_t i = 0; i < h_.symbols; ++i) {
    const uint32_t degree = active_.empty() ? 0 : surface_.degree_at_start(active_.back());
    Symbol symbol;
    if (!symbols_.next(degree, symbol)) return false;
    if (symbol != Symbol::kEnd && active_.empty()) return false;
    const uint32_t edge = add_triangle(i, symbol);
    if (edge == SurfaceBuilder::kNone) return false;
    active_.push_back(edge);
  }
  return true;
}

/// Takes what it joins from the active edges.
uint32_t Edgebreaker::add_triangle(uint32_t i, Symbol symbol) {
  switch (symbol) {
    case Symbol::kClose:
      return surface_.add_closing(pop_active());
    case Symbol::kSplit:
      return add_split(i);
    case Symbol::kLeft:
      return surface_.add_left(pop_active());
    case Symbol::kRight:
      return surface_.add_right(pop_active());
    case Symbol::kEnd:
      break;
  }
  return surface_.add_alone();
}

uint32_t Edgebreaker::add_split(uint32_t i) {
  const uint32_t b = pop_active();
  if (!waiting_.empty() && waiting_.front().split == i) {
    const uint32_t a = waiting_.front().edge;
    waiting_ = waiting_.subspan(1);
    return surface_.add_joining(a, b);
  }
  return active_.empty() ? SurfaceBuilder::kNone : surface_.add_joining(pop_active(), b);
}

bool Edgebreaker::finish_components() {
  while (!active_.empty()) {
    const uint32_t edge = pop_active();
    if (symbols_.next_start() ? surface_.add_last(edge) == SurfaceBuilder::kNone
                              : !surface_.is_free(edge)) {
      return false;
    }
  }
  return true;
}

uint32_t Edgebreaker::pop_active() {
  const uint32_t edge = active_.back();
  active_.pop_back();
  return edge;
}

bool has_degenerate_triangle(std::span<const uint32_t> triangles) {
  for (size_t t = 0; t < triangles.size(); t += 3) {
    const uint32_t* p = &triangles[t];
    if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) return true;
  }
  return false;
}

}  // namespace

uint64_t connectivity_triangle_count(std::span<const uint8_t> section) {
  ByteReader in(section);
  return read_section_header(in).triangles;
}

Status decode_connectivity(std::span<const uint8_t> section, const Limits& limits,
                           uint64_t max_triangles, PointTriangles& out) {
  ByteReader in(section);
  const SectionHeader h = read_section_header(in);
  if (!in.ok()) return Status::corrupt("connectivity: its header is malformed");
  if (Status s = check_section_header(h, limits, max_triangles); !s.ok()) return s;
  const auto symbol_count = static_cast<uint32_t>(h.symbols);
  std::vector<WaitingEdge> waiting;
  SymbolReader symbols;
  if (!read_waiting_edges(in, symbol_count, h.splits, waiting) ||
      !symbols.open(in, Traversal{h.traversal}, symbol_count) || in.remaining() != 0) {
    return Status::corrupt("connectivity: its codes are malformed");
  }
  Edgebreaker edgebreaker(h, symbols, waiting);
  if (!edgebreaker.decode())
    return Status::corrupt("connectivity: its symbols do not make its surface");
  out.point_count = static_cast<uint32_t>(h.vertices);
  out.triangles = edgebreaker.take_triangles();
  if (has_degenerate_triangle(out.triangles))
    return Status::corrupt("connectivity: a triangle has a point twice");
  return {};
}

}  // namespace reeb
