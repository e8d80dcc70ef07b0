// Nastran OUTPUT2: Fortran records that alternate between a key (one word) and data. A key n > 0 announces n words, a
// negative one ends a logical record, zero ends a table; the first data word of every logical record after the second
// is its kind (0: table).
#include "formats/matrices/detail/binary.hpp"
#include "formats/matrices/detail/input.hpp"
#include "formats/matrices/detail/mode_builder.hpp"

namespace bough::matrices::detail {
namespace {

/// Words of a record of identification, 0-based.
enum Ident : std::size_t {
  kApproach = 0,
  kTableCode = 1,
  kSubcase = 3,
  kMode = 4,
  kEigenvalue = 5,
  kFormat = 8,
  kWide = 9
};
constexpr std::size_t kIdentSize = 147;  ///< 146 words and the kind of the record
constexpr long kRealEigenvalues = 2, kEigenvectors = 7, kRealFormat = 1, kRealWords = 8;

bool holds_shapes(const std::string& name) {
  for (const char* known : {"OUGV1", "BOUGV1", "OUGV1PAT", "OUG1", "OPHIG", "BOPHIG"})
    if (name == known) return true;
  return false;
}

class Op2Reader {
 public:
  explicit Op2Reader(const std::string& path) : in_(path, read_bytes(path)) {}

  std::vector<ModeTable> read() {
    find_layout();
    while (!in_.is_at_end() && read_table()) {
    }
    std::vector<ModeTable> tables;
    for (const auto& [key, modes] : modes_) {
      ModeTable table;
      table.subcase = key.first;
      table.is_basic = key.second;
      if (!make_table(modes, table))
        in_.fail("matrices.op2", in_.get_offset(),
                 "the modes of subcase " + std::to_string(key.first) + " are not at the same nodes");
      if (lama_.size() == modes.size()) {
        table.generalized_mass.resize(table.eigenvalue.size());
        for (std::size_t j = 0; j < lama_.size(); ++j) {
          const auto i = static_cast<Eigen::Index>(j);
          table.generalized_mass(i) = lama_[j].mass;
          table.frequency_hz(i) = lama_[j].cycles;
          table.eigenvalue(i) = lama_[j].eigenvalue;
        }
      }
      tables.push_back(std::move(table));
    }
    return tables;
  }

 private:
  struct Eigenvalue {
    double eigenvalue = 0, cycles = 0, mass = 0;
  };

  void find_layout() {
    if (!in_.find_layout(read_bytes(in_.get_path(), 4), 4, 8))
      in_.fail("matrices.op2", 0, "the first record has neither 4 nor 8 bytes in either byte order");
  }

  long read_key() {
    record_at_ = in_.get_offset();
    const auto record = in_.read_record();
    if (record.size() != in_.get_word_size())
      fail("the record has " + std::to_string(record.size()) + " bytes, expected a key of " +
           std::to_string(in_.get_word_size()));
    return in_.get_integer(record, 0);
  }

  enum class End { Record, Table };
  /// A logical record: its data blocks one after the other. At the end of a table nothing.
  End read_logical(std::string& data) {
    data.clear();
    for (;;) {
      const long key = read_key();
      if (key < 0) return End::Record;
      if (key == 0) return End::Table;
      record_at_ = in_.get_offset();
      const auto record = in_.read_record();
      if (record.size() != static_cast<std::size_t>(key) * in_.get_word_size())
        fail("the record has " + std::to_string(record.size()) + " bytes, its key says " + std::to_string(key) +
             " words");
      data += record;
    }
  }

  std::size_t count_words(const std::string& data) const { return data.size() / in_.get_word_size(); }

  /// False at the end of the file: a key zero in place of a table.
  bool read_table() {
    std::string data;
    if (read_logical(data) == End::Table) return false;
    // The label of the file (date, "NASTRAN FORT TAPE ID CODE") is a record without a table: a zero follows.
    std::string name;
    if (count_words(data) == 2)
      for (const char c : data)
        if (c > ' ' && c <= '~') name += c;
    std::string ident;
    for (bool is_ident = true;;) {
      const auto end = read_logical(data);
      if (end == End::Table) return true;
      if (in_.is_at_end()) fail("the file ends within table " + name);
      const bool is_lama = name == "LAMA";
      if (!is_lama && !holds_shapes(name)) continue;
      if (data.size() < in_.get_word_size()) continue;
      // Trailer and header of the table come first; they are no pairs of identification and data.
      if (is_ident && count_words(data) < kIdentSize) {
        if (ident.empty()) continue;
        fail("an identification of table " + name + " has " + std::to_string(count_words(data)) + " words, expected " +
             std::to_string(kIdentSize));
      }
      data.erase(0, in_.get_word_size());
      if (is_ident) {
        ident = data;
      } else if (is_lama) {
        read_lama(data);
      } else {
        read_shapes(name, ident, data);
      }
      is_ident = !is_ident;
    }
  }

  void read_lama(const std::string& data) {
    lama_.clear();
    const std::size_t num_words = 7, word = in_.get_word_size();
    if (count_words(data) % num_words != 0)
      fail("table LAMA has " + std::to_string(count_words(data)) + " words, expected seven per mode");
    for (std::size_t at = 0; at < data.size(); at += num_words * word)
      lama_.push_back({in_.get_real(data, at + 2 * word, false), in_.get_real(data, at + 4 * word, false),
                       in_.get_real(data, at + 5 * word, false)});
  }

  void read_shapes(const std::string& name, const std::string& ident, const std::string& data) {
    const long approach = in_.get_integer(ident, kApproach) / 10, code = in_.get_integer(ident, kTableCode);
    if (approach != kRealEigenvalues || code % 1000 != kEigenvectors) return;  // displacements of another solution
    if (code / 1000 > 1) fail("table " + name + " is sorted by node (SORT2)", "ask for VECTOR(SORT1)");
    if (in_.get_integer(ident, kFormat) != kRealFormat || in_.get_integer(ident, kWide) != kRealWords)
      fail("table " + name + " has complex eigenvectors", "solve for real modes");
    const std::size_t word = in_.get_word_size(), row_size = static_cast<std::size_t>(kRealWords) * word;
    if (data.empty() || data.size() % row_size != 0)
      fail("table " + name + " has " + std::to_string(count_words(data)) + " words, expected eight per node");
    ModeRows mode{static_cast<int>(in_.get_integer(ident, kMode)), in_.get_real(ident, kEigenvalue * word, false), {}};
    for (std::size_t at = 0; at < data.size(); at += row_size) {
      NodeRow row;
      const auto words = std::string_view(data).substr(at, row_size);
      row.id = static_cast<int>(in_.get_integer(words, 0) / 10);
      row.is_scalar = in_.get_integer(words, 1) == 2;
      for (std::size_t c = 0; c < 6; ++c) {
        row.value[c] = in_.get_real(words, (2 + c) * word, false);
        if (row.is_scalar && c > 0) row.value[c] = 0;
        if (!std::isfinite(row.value[c])) fail("node " + std::to_string(row.id) + " has a value that is no number");
      }
      mode.rows.push_back(row);
    }
    modes_[{static_cast<int>(in_.get_integer(ident, kSubcase)), name.front() == 'B'}].push_back(std::move(mode));
  }

  [[noreturn]] void fail(const std::string& what, const std::string& advice = "write the file again") const {
    in_.fail("matrices.op2", record_at_, what, advice);
  }

  BinaryInput in_;
  std::size_t record_at_ = 0;
  std::map<std::pair<int, bool>, std::vector<ModeRows>> modes_;
  std::vector<Eigenvalue> lama_;
};

}  // namespace

std::vector<ModeTable> read_op2(const std::string& path) { return Op2Reader(path).read(); }

}  // namespace bough::matrices::detail
