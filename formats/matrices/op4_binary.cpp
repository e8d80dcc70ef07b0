#include "formats/matrices/detail/binary.hpp"
#include "formats/matrices/detail/input.hpp"
#include "formats/matrices/detail/op4_header.hpp"
#include "formats/matrices/op4.hpp"

namespace bough::matrices {
namespace {

using namespace detail;

class BinaryReader {
 public:
  explicit BinaryReader(const std::string& path) : in_(path, read_bytes(path)) {}

  std::vector<Matrix> read() {
    std::vector<Matrix> matrices;
    find_layout();
    while (!in_.is_at_end()) matrices.push_back(read_matrix());
    return matrices;
  }

 private:
  /// The first record is a header: four words and a name of two, 24 bytes, or 48 with words of 8 bytes.
  void find_layout() {
    if (!in_.find_layout(read_bytes(in_.get_path(), 4), 24, 48))
      in_.fail("matrices.op4-header", 0, "the first record has neither 24 nor 48 bytes in either byte order");
  }

  Matrix read_matrix() {
    record_at_ = in_.get_offset();
    auto record = in_.read_record();
    if (record.size() != 6 * in_.get_word_size())
      fail("matrices.op4-header", "the record has " + std::to_string(record.size()) +
                                      " bytes, expected the header of a matrix of " +
                                      std::to_string(6 * in_.get_word_size()));
    header_ = {in_.get_integer(record, 0),
               in_.get_integer(record, 1),
               in_.get_integer(record, 2),
               in_.get_integer(record, 3),
               {},
               false};
    for (const char c : trim(record.substr(4 * in_.get_word_size())))
      if (c > ' ' && c <= '~') header_.name += c;
    settle_header(header_, in_.get_size(), claimed_,
                  [this](const char* id, const std::string& what) { fail(id, what); });
    words_per_real_ = header_.is_double() && !in_.is_64_bit() ? 2 : 1;
    Triplets entries;
    for (;;) {
      record_at_ = in_.get_offset();
      record = in_.read_record();
      if (record.size() < 3 * in_.get_word_size())
        fail("matrices.op4-column", "the record has " + std::to_string(record.size()) + " bytes, expected a column");
      const long column = in_.get_integer(record, 0), row = in_.get_integer(record, 1),
                 count = in_.get_integer(record, 2);
      if (column > header_.num_cols) return make_op4_matrix(header_, entries);
      record.remove_prefix(3 * in_.get_word_size());
      if (column < 1 || row < 0 || count < 0 || static_cast<std::size_t>(count) > record.size() / in_.get_word_size())
        fail("matrices.op4-column", "column " + std::to_string(column) + ", first row " + std::to_string(row) + ", " +
                                        std::to_string(count) + " words in a record of " +
                                        std::to_string(record.size()) + " bytes");
      record = record.substr(0, static_cast<std::size_t>(count) * in_.get_word_size());
      if (row > 0) {
        read_reals(record, row, column, entries);
      } else {
        read_strings(record, column, entries);
      }
    }
  }

  void read_strings(std::string_view words, long column, Triplets& entries) {
    const std::size_t num_header_words = header_.is_bigmat ? 2 : 1;
    while (!words.empty()) {
      if (words.size() < num_header_words * in_.get_word_size())
        fail("matrices.op4-string", "the column ends within the header of a string");
      const auto string = header_.is_bigmat ? StringHeader{in_.get_integer(words, 0) - 1, in_.get_integer(words, 1)}
                                            : unpack_string_header(in_.get_integer(words, 0));
      words.remove_prefix(num_header_words * in_.get_word_size());
      if (string.num_words <= 0 || string.row < 1 ||
          static_cast<std::size_t>(string.num_words) > words.size() / in_.get_word_size())
        fail("matrices.op4-string", "column " + std::to_string(column) + " has a string of " +
                                        std::to_string(string.num_words) + " words from row " +
                                        std::to_string(string.row) + ", " +
                                        std::to_string(words.size() / in_.get_word_size()) + " words are left");
      const std::size_t size = static_cast<std::size_t>(string.num_words) * in_.get_word_size();
      read_reals(words.substr(0, size), string.row, column, entries);
      words.remove_prefix(size);
    }
  }

  void read_reals(std::string_view bytes, long row, long column, Triplets& entries) {
    const std::size_t size = static_cast<std::size_t>(words_per_real_) * in_.get_word_size();
    const long num_reals = static_cast<long>(bytes.size() / size);
    const long num_entries = num_reals / header_.reals_per_entry();
    if (row + num_entries - 1 > header_.num_rows)
      fail("matrices.op4-column", std::to_string(num_entries) + " entries from row " + std::to_string(row) +
                                      " of column " + std::to_string(column) + ", the matrix has " +
                                      std::to_string(header_.num_rows) + " rows");
    const auto read_real = [&](long i) {
      return in_.get_real(bytes, static_cast<std::size_t>(i) * size, header_.is_double());
    };
    for (long i = 0; i < num_entries; ++i) {
      const double re = read_real(i * header_.reals_per_entry()), im = header_.is_complex() ? read_real(2 * i + 1) : 0;
      if (re - re != 0 || im - im != 0)
        fail("matrices.bad-number", "row " + std::to_string(row + i) + " of column " + std::to_string(column) +
                                        " of matrix " + header_.name + " is not a finite number");
      if (re != 0 || im != 0) entries.add(static_cast<int>(row + i) - 1, static_cast<int>(column) - 1, re, im);
    }
  }

  [[noreturn]] void fail(const char* id, const std::string& what) const {
    in_.fail(id, record_at_, what, "the file is damaged or of a kind not known: write it again");
  }

  BinaryInput in_;
  Op4Header header_;
  double claimed_ = 0;
  long words_per_real_ = 1;
  std::size_t record_at_ = 0;
};

}  // namespace

std::vector<Matrix> read_op4_binary(const std::string& path) { return BinaryReader(path).read(); }

}  // namespace bough::matrices
