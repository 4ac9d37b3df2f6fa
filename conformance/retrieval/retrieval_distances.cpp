// Distances between all shapes of a list, by every method.
//
//   retrieval_distances LIST OUTPUT
//   retrieval_distances --variants        (names them)
//
// LIST has a line per shape: class, file, frame (from 1) and variant ("-" or one of variants.h),
// separated by tabs. OUTPUT gets, per method, a line with its name and a line of numbers per shape
// of the list; then a line "seconds" and the processor time that each shape's signature took; then
// a line "comparison" and the processor time that comparing two of them took.
#include <atomic>
#include <cmath>
#include <ctime>
#include <fstream>
#include <functional>
#include <iostream>
#include <sstream>

#include "codec/common/mesh/faces.h"
#include "conformance/retrieval/baselines.h"
#include "conformance/retrieval/variants.h"
#include "retrieval/shape_distance.h"
#include "tools/io/read_sequence.h"
#include "tools/parallel.h"

namespace {

using namespace reeb;
using conformance::PlainMesh;

struct Item {
  std::string kind, file, variant;
  uint32_t frame = 1;
};

struct Described {
  retrieval::Signature signature;
  conformance::Baselines baselines;
  double seconds = 0;
};

std::vector<Item> read_list(const char* name) {
  std::ifstream in(name);
  std::vector<Item> items;
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    Item item;
    std::string frame;
    std::getline(fields, item.kind, '\t');
    std::getline(fields, item.file, '\t');
    std::getline(fields, frame, '\t');
    std::getline(fields, item.variant, '\t');
    item.frame = static_cast<uint32_t>(std::stoul(frame));
    items.push_back(item);
  }
  return items;
}

bool read_mesh(const Item& item, PlainMesh& mesh) {
  Sequence sequence;
  tools::ReadReport report;
  const Status status = tools::read_sequence({item.file}, {.threads = 1}, sequence, report);
  if (!status.ok()) {
    std::cerr << status.message() << "\n";
    return false;
  }
  uint32_t frame = item.frame - 1;
  for (const Shot& shot : sequence.shots) {
    if (frame < shot.frame_count) {
      mesh = {{shot.frame(frame).begin(), shot.frame(frame).end()},
              fan_triangles(shot.connectivity)};
      return item.variant == "-" || conformance::make_variant(item.variant, mesh);
    }
    frame -= shot.frame_count;
  }
  std::cerr << item.file << ": no frame " << item.frame << "\n";
  return false;
}

double difference(const std::vector<double>& a, const std::vector<double>& b, int power) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += std::pow(std::abs(a[i] - b[i]), power);
  return sum;
}

using Distance = std::function<double(const Described&, const Described&)>;

const std::vector<std::pair<const char*, Distance>>& methods() {
  static const auto part = [](double retrieval::ShapeDistance::*member) {
    return [member](const Described& a, const Described& b) {
      return shape_distance(a.signature, b.signature).*member;
    };
  };
  static const std::vector<std::pair<const char*, Distance>> list{
      {"Reeb", part(&retrieval::ShapeDistance::total)},
      {"Reeb, charts alone", part(&retrieval::ShapeDistance::charts)},
      {"Reeb, spectrum alone", part(&retrieval::ShapeDistance::spectrum)},
      {"Reeb, body alone", part(&retrieval::ShapeDistance::body)},
      {"ShapeDNA",
       [](const Described& a, const Described& b) {
         return difference(a.baselines.shape_dna, b.baselines.shape_dna, 2);
       }},
      {"heat kernel histogram",
       [](const Described& a, const Described& b) {
         return difference(a.baselines.heat_histogram, b.baselines.heat_histogram, 1);
       }},
      {"D2", [](const Described& a,
                const Described& b) { return difference(a.baselines.d2, b.baselines.d2, 1); }},
  };
  return list;
}

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void write(std::ostream& out, const std::vector<Described>& shapes) {
  const double start = thread_seconds();
  double sum = 0;
  for (const Described& a : shapes) {
    for (const Described& b : shapes) sum += shape_distance(a.signature, b.signature).total;
  }
  const double seconds =
      (thread_seconds() - start) / static_cast<double>(shapes.size() * shapes.size());
  for (const auto& [name, distance] : methods()) {
    out << name << "\n";
    for (const Described& a : shapes) {
      for (const Described& b : shapes) out << (&b == &shapes[0] ? "" : " ") << distance(a, b);
      out << "\n";
    }
  }
  out << "seconds\n";
  for (const Described& a : shapes) out << (&a == &shapes[0] ? "" : " ") << a.seconds;
  out << "\ncomparison\n" << seconds << " " << sum << "\n";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && argv[1] == std::string("--variants")) {
    for (const std::string& name : conformance::variant_names()) std::cout << name << "\n";
    return 0;
  }
  if (argc != 3) {
    std::cerr << "usage: retrieval_distances LIST OUTPUT, or --variants\n";
    return 2;
  }
  const std::vector<Item> items = read_list(argv[1]);
  std::vector<Described> shapes(items.size());
  std::atomic<bool> failed{false};
  tools::parallel_for(items.size(), 0, [&](size_t i) {
    PlainMesh mesh;
    if (!read_mesh(items[i], mesh)) {
      failed = true;
      return;
    }
    const double start = thread_seconds();
    const retrieval::Signature found = retrieval::sign(mesh.positions, mesh.triangles).signature;
    shapes[i].seconds = thread_seconds() - start;
    // As archives hold it.
    if (!from_bytes(to_bytes(found), shapes[i].signature)) failed = true;
    shapes[i].baselines = conformance::describe(mesh.positions, mesh.triangles);
  });
  if (failed) return 1;
  std::ofstream out(argv[2]);
  write(out, shapes);
  return out ? 0 : 1;
}
