#include "formats/listing/op2.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>

#include "base/diagnostic.hpp"

namespace bough::listing {
namespace {

using records::ListedKind;
using records::ListedStep;

constexpr int kIdentWords = 146, kDevice = 1;

/// 4-byte words.
class Words {
 public:
  void add(int value) { add_bits(static_cast<std::uint32_t>(value)); }
  /// No number: 1 as an integer, as Nastran has it.
  void add(double value) {
    add_bits(std::isnan(value) ? 1U : std::bit_cast<std::uint32_t>(static_cast<float>(value)));
  }
  void add(const std::string& text, std::size_t size) {
    std::string padded = text.substr(0, size);
    for (char& c : padded)
      if (static_cast<unsigned char>(c) > '~') c = '?';
    padded.resize(size, ' ');
    bytes_ += padded;
  }
  void set(std::size_t index, int value) { set_bits(index, static_cast<std::uint32_t>(value)); }
  void set(std::size_t index, double value) {
    set_bits(index, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
  }
  int count() const { return static_cast<int>(bytes_.size() / 4); }
  const std::string& bytes() const { return bytes_; }

 private:
  static std::array<char, 4> split(std::uint32_t bits) {
    return {static_cast<char>(bits & 255U), static_cast<char>(bits >> 8U & 255U), static_cast<char>(bits >> 16U & 255U),
            static_cast<char>(bits >> 24U & 255U)};
  }
  void add_bits(std::uint32_t bits) {
    const auto four = split(bits);
    bytes_.append(four.data(), four.size());
  }
  void set_bits(std::size_t index, std::uint32_t bits) {
    const auto four = split(bits);
    bytes_.replace(4 * index, 4, four.data(), four.size());
  }
  std::string bytes_;
};

class Op2Writer {
 public:
  Op2Writer() {
    Words date;
    for (const int part : {1, 1, 0}) date.add(part);  // the same input gives the same file
    put_block(date);
    Words tape;
    tape.add("NASTRAN FORT TAPE ID CODE - ", 28);
    put_block(tape);
    Words label;
    label.add("XXXXXXXX", 8);
    put_block(label);
    put_key(-1);
    put_key(0);
  }

  void begin_table(const std::string& name, const std::string& inner) {
    Words words;
    words.add(name, 8);
    put_block(words);
    put_key(-1);
    Words trailer;
    for (const int word : {102, 0, 0, 0, 512, 0, 0}) trailer.add(word);
    put_block(trailer);
    next_ = -2;
    begin_record();
    Words head;
    head.add(inner, 8);
    for (const int word : {1, 1, 0, 0, 1}) head.add(word);
    put_block(head);
  }
  void add_record(const Words& words) {
    begin_record();
    put_block(words);
  }
  void end_table() {
    begin_record();
    put_key(0);
  }
  std::string finish() {
    put_key(0);
    return std::move(bytes_);
  }

 private:
  void put_record(const std::string& data) {
    Words length;
    length.add(static_cast<int>(data.size()));
    bytes_ += length.bytes() + data + length.bytes();
  }
  void put_key(int key) {
    Words word;
    word.add(key);
    put_record(word.bytes());
  }
  void put_block(const Words& words) {
    put_key(words.count());
    put_record(words.bytes());
  }
  /// -n ends the record before; the first word of the next says that it belongs to a table.
  void begin_record() {
    put_key(next_--);
    Words kind;
    kind.add(0);
    put_block(kind);
  }

  std::string bytes_;
  int next_ = -2;
};

struct Head {
  int analysis = 1, table = 1, subcase = 0;
  std::string title, subtitle, label;
};

/// Words 1 to 50, then title, subtitle and label.
Words make_ident(const Head& head) {
  Words words;
  for (int i = 0; i < 50; ++i) words.add(0);
  words.set(0, 10 * head.analysis + kDevice);
  words.set(1, head.table);
  words.set(3, head.subcase);
  for (const auto* text : {&head.title, &head.subtitle, &head.label}) words.add(*text, 128);
  BOUGH_DEMAND(words.count() == kIdentWords);
  return words;
}

Head make_head(const ListedStep& step, int table) {
  static const std::map<ListedStep::Kind, int> analyses{{ListedStep::Kind::Static, 1},
                                                        {ListedStep::Kind::Mode, 2},
                                                        {ListedStep::Kind::Frequency, 5},
                                                        {ListedStep::Kind::Time, 6}};
  return {analyses.at(step.kind), table, step.subcase, step.title, step.subtitle, step.label};
}

/// Words 5 to 8: what the step is of.
void set_step(const ListedStep& step, Words& ident) {
  switch (step.kind) {
    case ListedStep::Kind::Static:
      ident.set(4, step.load_set);
      break;
    case ListedStep::Kind::Mode:
      ident.set(4, step.mode);
      ident.set(5, step.eigenvalue);
      ident.set(6, step.cycles);
      break;
    default:
      ident.set(4, step.at);
  }
  ident.set(7, step.load_set);
}

void add_weight(const records::ListedWeight& weight, const Head& of, Op2Writer& file) {
  Head head = of;
  head.table = 13;
  Words ident = make_ident(head), data;
  ident.set(2, weight.grid);
  ident.set(9, 78);
  const auto add = [&](const auto& matrix) {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
      for (Eigen::Index j = 0; j < matrix.cols(); ++j) data.add(matrix(i, j));
  };
  add(weight.MO);
  add(weight.S);
  for (int i = 0; i < 3; ++i) {
    data.add(weight.mass(i));
    for (int j = 0; j < 3; ++j) data.add(weight.cg(i, j));
  }
  add(weight.I_S);
  add(weight.I_Q);
  add(weight.Q);
  file.begin_table("OGPWG", "OGPWG");
  file.add_record(ident);
  file.add_record(data);
  file.end_table();
}

void add_roots(const std::vector<records::ListedRoots>& all, Op2Writer& file) {
  file.begin_table("LAMA", "LAMA");
  for (const auto& roots : all) {
    Words ident = make_ident({2, 6, roots.subcase, roots.title, roots.subtitle, roots.label}), data;
    ident.set(8, 1);
    ident.set(9, 7);
    for (Eigen::Index j = 0; j < roots.eigenvalue.size(); ++j) {
      const double omega = std::sqrt(std::abs(roots.eigenvalue(j)));
      data.add(static_cast<int>(j) + 1);
      data.add(static_cast<int>(j) + 1);
      for (const double value : {roots.eigenvalue(j), omega, omega / (2 * M_PI), roots.mass(j), roots.stiffness(j)})
        data.add(value);
    }
    file.add_record(ident);
    file.add_record(data);
  }
  file.end_table();
}

void add_vector(const ListedStep& step, const records::ListedVector& vector, Op2Writer& file) {
  const bool is_complex = vector.imag.size() > 0;
  Words ident = make_ident(make_head(step, static_cast<int>(vector.kind) + (is_complex ? 1000 : 0))), data;
  set_step(step, ident);
  ident.set(8, !is_complex ? 1 : vector.is_phase ? 3 : 2);
  ident.set(9, is_complex ? 14 : 8);
  for (std::size_t k = 0; k < vector.id.size(); ++k) {
    data.add(10 * vector.id[k] + kDevice);
    data.add(vector.is_scalar[k] ? 2 : 1);
    for (int c = 0; c < 6; ++c) data.add(vector.real(static_cast<Eigen::Index>(k), c));
    for (int c = 0; c < 6 && is_complex; ++c) data.add(vector.imag(static_cast<Eigen::Index>(k), c));
  }
  file.add_record(ident);
  file.add_record(data);
}

constexpr int kBeam = 2, kBeamStations = 11;

/// Nastran writes eleven stations of every beam; what lies between the ends is empty.
void add_beam_row(const records::ListedElements& block, std::size_t k, Words& data) {
  const auto row = static_cast<Eigen::Index>(k);
  const Eigen::Index half = block.real.cols() / 2;
  for (int station = 0; station < kBeamStations; ++station) {
    const bool is_a = station == 0, is_b = station == kBeamStations - 1;
    data.add(is_a ? block.ends[k][0] : is_b ? block.ends[k][1] : 0);
    data.add(is_b ? 1.0 : 0.0);
    for (Eigen::Index c = 0; c < half; ++c)
      data.add(is_a ? block.real(row, c) : is_b ? block.real(row, half + c) : 0.0);
  }
}

/// Eleven stations of grid, x/L, SXC to SXF, largest, smallest, two margins.
void add_beam_stresses(const records::ListedElements& block, std::size_t k, Words& data) {
  for (int station = 0; station < kBeamStations; ++station) {
    const bool is_a = station == 0, is_b = station == kBeamStations - 1;
    data.add(is_a ? block.ends[k][0] : is_b ? block.ends[k][1] : 0);
    data.add(is_b ? 1.0 : 0.0);
    for (int c = 0; c < 8; ++c) data.add(is_a || is_b ? block.real(static_cast<Eigen::Index>(k), c + 8 * is_b) : 0.0);
  }
}

bool is_solid(int type) { return type == 39 || type == 67 || type == 68; }
bool is_layered(int type) { return type == 95 || type == 97; }

/// A solid is one entry: its head, then the centre and each corner.
void add_solid_row(const records::ListedElements& block, std::size_t k, Words& data) {
  if (block.point[k] == 0) {
    int corners = 0;
    for (auto i = k + 1; i < block.id.size() && block.point[i] != 0; ++i) ++corners;
    data.add(10 * block.id[k] + kDevice);
    data.add(0);
    data.add("GRID", 4);
    data.add(corners);
  }
  data.add(block.point[k]);
  for (Eigen::Index c = 0; c < block.real.cols(); ++c) data.add(block.real(static_cast<Eigen::Index>(k), c));
}

/// Stresses: by element, layer or corner (docs/formats/op2.md).
void add_stresses(const ListedStep& step, const records::ListedElements& block, Op2Writer& file) {
  Words ident = make_ident(make_head(step, 5)), data;
  set_step(step, ident);
  ident.set(2, block.type);
  ident.set(8, 1);
  ident.set(10, is_layered(block.type) ? 0 : 1);  // largest shear, or von Mises
  int count = 0;
  for (std::size_t k = 0; k < block.id.size(); ++k) {
    if (is_solid(block.type)) {
      add_solid_row(block, k, data);
      count += block.point[k] == 0;
      continue;
    }
    ++count;
    data.add(10 * block.id[k] + kDevice);
    if (is_layered(block.type)) data.add(block.point[k]);
    if (block.type == kBeam)
      add_beam_stresses(block, k, data);
    else
      for (Eigen::Index c = 0; c < block.real.cols(); ++c) data.add(block.real(static_cast<Eigen::Index>(k), c));
  }
  ident.set(9, count == 0 ? 0 : data.count() / count);
  file.add_record(ident);
  file.add_record(data);
}

void add_elements(const ListedStep& step, const records::ListedElements& block, int table, Op2Writer& file) {
  Words ident = make_ident(make_head(step, table)), data;
  set_step(step, ident);
  ident.set(2, block.type);
  ident.set(8, 1);
  for (std::size_t k = 0; k < block.id.size(); ++k) {
    data.add(10 * block.id[k] + kDevice);
    if (block.type == kBeam)
      add_beam_row(block, k, data);
    else
      for (Eigen::Index c = 0; c < block.real.cols(); ++c) data.add(block.real(static_cast<Eigen::Index>(k), c));
  }
  ident.set(9, block.id.empty() ? 0 : data.count() / static_cast<int>(block.id.size()));
  file.add_record(ident);
  file.add_record(data);
}

void add_vectors(const records::Listing& listing, const char* name, const char* inner,
                 const std::function<bool(ListedKind)>& is_of, Op2Writer& file) {
  bool is_open = false;
  for (const auto& step : listing.steps)
    for (const auto& vector : step.vectors) {
      if (!is_of(vector.kind) || vector.id.empty()) continue;
      if (!is_open) file.begin_table(name, inner);
      is_open = true;
      add_vector(step, vector, file);
    }
  if (is_open) file.end_table();
}

template <class Add>
void add_blocks(const records::Listing& listing, const char* name,
                std::vector<records::ListedElements> ListedStep::*blocks, const std::function<bool(int)>& is_of,
                const Add& add, Op2Writer& file) {
  bool is_open = false;
  for (const auto& step : listing.steps)
    for (const auto& block : step.*blocks) {
      if (block.id.empty() || !is_of(block.type)) continue;
      if (!is_open) file.begin_table(name, name);
      is_open = true;
      add(step, block, file);
    }
  if (is_open) file.end_table();
}

}  // namespace

std::string make_op2(const records::Listing& listing) {
  Op2Writer file;
  if (listing.weight) {
    Head head;
    if (!listing.steps.empty()) head = make_head(listing.steps.front(), 13);
    head.subcase = 0;
    add_weight(*listing.weight, head, file);
  }
  if (!listing.roots.empty()) add_roots(listing.roots, file);
  add_vectors(
      listing, "OUGV1", "OUG1",
      [](ListedKind k) {
        return k == ListedKind::Displacement || k == ListedKind::Eigenvector || k == ListedKind::Velocity ||
               k == ListedKind::Acceleration;
      },
      file);
  add_vectors(
      listing, "OPG1", "OPG1", [](ListedKind k) { return k == ListedKind::Load; }, file);
  add_vectors(
      listing, "OQG1", "OQG1", [](ListedKind k) { return k == ListedKind::SpcForce; }, file);
  add_vectors(
      listing, "OQMG1", "OQMG1", [](ListedKind k) { return k == ListedKind::MpcForce; }, file);
  const auto add_forces = [](const ListedStep& step, const records::ListedElements& block, Op2Writer& to) {
    add_elements(step, block, 4, to);
  };
  add_blocks(
      listing, "OEF1", &ListedStep::forces, [](int) { return true; }, add_forces, file);
  add_blocks(
      listing, "OES1", &ListedStep::stresses, [](int type) { return !is_layered(type); }, add_stresses, file);
  add_blocks(listing, "OES1C", &ListedStep::stresses, is_layered, add_stresses, file);
  return file.finish();
}

}  // namespace bough::listing
