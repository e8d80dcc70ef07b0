// Bough's HDF5 files: what is written reads back, and written again gives the same bytes.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "formats/hdf5/comparison_file.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/hdf5/linear_file.hpp"
#include "formats/hdf5/sweep_file.hpp"
#include "formats/hdf5/table_file.hpp"
#include "formats/toml/key_editor.hpp"
#include "formats/toml/specs.hpp"
#include "tests/formats/hdf5/random_body.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/temp_folder.hpp"

namespace bough::hdf5 {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using records::LinearModel;
using test::TempFolder;

class Drawn : public test::Draws<std::mt19937> {
 public:
  using Draws::Draws;

  /// Draws a value of any magnitude.
  double draw_value() {
    const double mantissa = std::uniform_real_distribution<double>(-10, 10)(random_);
    return draw(0, 9) == 0 ? 0.0 : mantissa * std::pow(10.0, draw(-300, 300));
  }

  MatrixXd draw_matrix(Eigen::Index rows, Eigen::Index columns) {
    return MatrixXd::NullaryExpr(rows, columns, [&] { return draw_value(); });
  }
  VectorXd draw_vector(Eigen::Index size) { return draw_matrix(size, 1); }

  std::string draw_word() {
    static const std::vector<std::string> pieces{"a", "Z", "9", "_", "-", ".", " ", "ä", "≠", "/", ":", "\"", "x"};
    std::string word;
    for (int k = draw(1, 12); k > 0; --k) word += pieces[static_cast<std::size_t>(draw(0, 12))];
    return word;
  }
  std::vector<std::string> draw_words(int count) {
    std::vector<std::string> words;
    for (int k = 0; k < count; ++k) words.push_back(draw_word());
    return words;
  }

  LinearModel draw_model(int nx, int nu, int ny) {
    LinearModel m;
    m.source = {{draw_word(), std::string(64, 'a')}, {draw_word(), std::string(64, 'b')}};
    m.A = draw_matrix(nx, nx);
    m.B = draw_matrix(nx, nu);
    m.C = draw_matrix(ny, nx);
    m.D = draw_matrix(ny, nu);
    m.states = {draw_words(nx), draw_words(nx)};
    m.inputs = {draw_words(nu), draw_words(nu)};
    m.outputs = {draw_words(ny), draw_words(ny)};
    m.time = draw_value();
    m.q = draw_vector(nx + 1);
    m.u = draw_vector(nx);
    m.q_names = {draw_words(nx + 1), draw_words(nx + 1)};
    m.u_names = {draw_words(nx), draw_words(nx)};
    m.periodic = draw_words(draw(0, 2));
    m.residual = draw_value();
    m.error = draw_value();
    m.difference = draw_value();
    m.poles = {draw_vector(nx), draw_vector(nx), draw_vector(nx), draw_vector(nx),
               draw_vector(nx), draw_words(nx),  draw_words(nx),  draw_words(nx)};
    m.has_zeros = draw(0, 1) == 1;
    if (m.has_zeros) {
      m.zeros_real = draw_vector(2);
      m.zeros_imag = draw_vector(2);
    }
    if (draw(0, 1) == 1) {
      m.multipliers.period = std::abs(draw_value()) + 0.1;
      m.multipliers.num_samples = draw(1, 9);
      for (auto* v : {&m.multipliers.real, &m.multipliers.imag, &m.multipliers.decay, &m.multipliers.frequency_hz})
        *v = draw_vector(nx);
      m.multipliers.mode = draw_words(nx);
    }
    if (draw(0, 1) == 1) m.hankel = {draw_vector(nx), draw_matrix(nx, nx), draw_matrix(nx, nx), draw(0, 3)};
    return m;
  }
};

/// Writes what `read` made of the first file, and compares both files.
template <class Write, class Read>
void expect_same_bytes(const Write& write, const Read& read) {
  const TempFolder folder;
  write(folder.at("a.h5"));
  const auto found = read(folder.at("a.h5"));
  found(folder.at("b.h5"));
  EXPECT_EQ(test::read_bytes(folder.at("a.h5")), test::read_bytes(folder.at("b.h5")));
}

TEST(FileRoundTrips, LinearModels) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    Drawn drawn(seed);
    const auto model = drawn.draw_model(drawn.draw(1, 6), drawn.draw(0, 3), drawn.draw(0, 3));
    expect_same_bytes([&](const std::string& path) { write_linear_model(model, path); },
                      [&](const std::string& path) {
                        const auto found = read_linear_model(path);
                        EXPECT_EQ(found.A, model.A);
                        EXPECT_EQ(found.D, model.D);
                        EXPECT_EQ(found.states.name, model.states.name);
                        EXPECT_EQ(found.poles.hinge, model.poles.hinge);
                        EXPECT_EQ(found.hankel.value, model.hankel.value);
                        return [found](const std::string& other) { write_linear_model(found, other); };
                      });
  }
}

TEST(FileRoundTrips, OutcomesOfCampaigns) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    Drawn drawn(seed);
    OutcomeTable table;
    table.name = drawn.draw_word();
    table.fingerprint = std::string(64, 'f');
    const int rows = drawn.draw(1, 9);
    for (int k = 0; k < rows; ++k) table.cases.push_back(3 * k + 1);
    for (int k = 0; k < drawn.draw(1, 5); ++k) {
      OutcomeColumn column;
      column.path = "/results/c" + std::to_string(k);
      column.description = drawn.draw_word();
      if (drawn.draw(0, 2) == 0)
        column.words = drawn.draw_words(rows);
      else
        column.numbers = drawn.draw_matrix(rows, drawn.draw(1, 3));
      table.columns.push_back(column);
    }
    expect_same_bytes([&](const std::string& path) { write_outcomes(table, path); },
                      [&](const std::string& path) {
                        const auto found = read_outcomes(path);
                        EXPECT_EQ(found.cases, table.cases);
                        EXPECT_EQ(found.columns.size(), table.columns.size());
                        return [found](const std::string& other) { write_outcomes(found, other); };
                      });
  }
}

void expect_same_modes(const records::ModesResult& modes) {
  expect_same_bytes([&](const std::string& path) { write_modes(modes, path); },
                    [&](const std::string& path) {
                      const auto found = read_modes(path);
                      EXPECT_TRUE(test::are_identical(found, modes));
                      return [found](const std::string& other) { write_modes(found, other); };
                    });
}

TEST(FileRoundTrips, BodiesAndModes) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Drawn drawn(seed);
    const int n = drawn.draw(0, 7), p = drawn.draw(2, 6);
    const auto body = test::make_random_body(seed, n, p, drawn.draw(0, 1) == 1);
    expect_same_bytes([&](const std::string& path) { write_flex_body(body, path); },
                      [&](const std::string& path) {
                        const auto found = read_flex_body(path);
                        EXPECT_TRUE(n == 0 || test::are_identical(found, body));  // of no modes: by the bytes
                        return [found](const std::string& other) { write_flex_body(found, other); };
                      });
    const auto modes = test::make_random_modes(seed, n + 1, p);
    expect_same_modes(modes);
  }
}

/// More shapes than are written at a time, the last time fewer.
TEST(FileRoundTrips, ManyModes) {
  const auto modes = test::make_random_modes(1, 300, 700);
  expect_same_modes(modes);
}

TEST(FileRoundTrips, KeysOfTomlFiles) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    Drawn drawn(seed);
    std::string text = "[body]\nname = \"rod\" # the name\ndeck = \"rod.bdf\"\n[body.modes]\nnumber = 2\n";
    std::string name = "d" + drawn.draw_word();
    std::replace(name.begin(), name.end(), '/', '_');  // a path of its own
    const int number = drawn.draw(1, 1000000);
    EXPECT_EQ(toml_files::set_key(text, "body.deck", toml_files::quote_text(name)), "");
    EXPECT_EQ(toml_files::set_key(text, "body.modes.number", std::to_string(number)), "");
    Diagnostics diagnostics;
    const auto spec = toml_files::read_body_spec_text(text, "rod.toml", diagnostics);
    EXPECT_EQ(diagnostics.num_errors(), 0) << text;
    EXPECT_EQ(spec.deck.substr(spec.deck.size() - std::min(name.size(), spec.deck.size())), name);
    EXPECT_NE(text.find(" # the name"), std::string::npos);
    // Setting the same value again changes nothing.
    const std::string before = text;
    EXPECT_EQ(toml_files::set_key(text, "body.deck", toml_files::quote_text(name)), "");
    EXPECT_EQ(text, before);
  }
}

}  // namespace
}  // namespace bough::hdf5
