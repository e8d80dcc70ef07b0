#pragma once
/// \file One card on its way to text: fields in order, then lines of 8 or 16 columns or between commas.
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <Eigen/Dense>

#include "formats/nastran/writer.hpp"

namespace bough::nastran::detail {

/// The best text of at most `width` characters (8 or more) that Nastran reads as a real: with a point, an exponent as
/// "+5" or "-12". Exact where the width allows, else the value rounded to as many digits as fit. Independent of the
/// locale.
std::string format_real(double value, int width);
/// 17 significant digits where they are needed: reads back as the same double.
std::string format_exact_real(double value);

/// Fields after the name; each `add` gives the next one.
class CardFields {
 public:
  explicit CardFields(std::string name) : name_(std::move(name)) {}

  /// Adds an integer.
  CardFields& add(int value);
  /// Adds a real, written with as many digits as the columns of its field hold.
  CardFields& add(double value);
  /// Adds a real; blank without one.
  CardFields& add(const std::optional<double>& value);
  /// Adds three reals.
  CardFields& add(const Eigen::Vector3d& v);
  /// Adds a word, unchanged.
  CardFields& add_word(std::string_view word);
  /// Adds `count` blank fields.
  CardFields& add_blank(int count = 1);
  CardFields& add_id(int id);                 ///< blank for 0
  CardFields& add_components(unsigned mask);  ///< blank for 0
  CardFields& end_line();                     ///< blanks up to the next line's first field

  /// Name of the card.
  const std::string& get_name() const { return name_; }
  /// Number of fields after the name so far.
  std::size_t get_size() const { return fields_.size(); }
  /// Appends the lines of the card.
  void write(FieldFormat format, std::string& out) const;

 private:
  using Field = std::variant<std::monostate, int, double, std::string>;

  bool fits(int width, bool exactly) const;
  void write_fixed(int width, std::size_t count, std::string& out) const;
  void write_free(std::size_t count, std::string& out) const;

  std::string name_;
  std::vector<Field> fields_;
};

}  // namespace bough::nastran::detail
