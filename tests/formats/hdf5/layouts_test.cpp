/// The layouts of the HDF5 files: each array that is written has its row, and the tables of docs/formats are those of
/// the layouts (BOUGH_WRITE_PAGES=1 writes them).
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/hdf5/layouts.hpp"
#include "tests/formats/hdf5/random_body.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temp_folder.hpp"

namespace bough::hdf5 {
namespace {

using test::TempFolder;
using testing::ElementsAre;
using testing::IsEmpty;

FileInfo write_and_list_body() {
  const TempFolder folder;
  write_flex_body(test::make_random_body(3, 4, 3, true), folder.at("body.h5"));
  return read_info(folder.at("body.h5"));
}

FileInfo remove(FileInfo info, const std::string& path) {
  std::erase_if(info.objects, [&](const auto& object) { return object.path == path; });
  return info;
}

FileInfo change(FileInfo info, const std::string& path, std::string ObjectInfo::*member, const std::string& text) {
  for (auto& object : info.objects)
    if (object.path == path) object.*member = text;
  return info;
}

std::string replace_all(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

/// "/third_order/energy_{k}" as the manual names it.
std::string format_path(std::string_view path) {
  std::string text(path);
  if (text.starts_with("/@")) text = text.substr(2);
  for (std::size_t at = 0; (at = text.find('{')) != std::string::npos;) {
    const auto end = text.find('}', at);
    std::string word = text.substr(at + 1, end - at - 1);
    if (word.size() > 1)
      for (char& c : word) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    text = text.substr(0, at) + word + text.substr(end + 1);
  }
  return text;
}

std::string join(std::initializer_list<std::string> texts, const std::string& separator) {
  std::string all;
  for (const auto& text : texts) all += (all.empty() || text.empty() ? "" : separator) + text;
  return all;
}

std::string make_table(const Layout& layout) {
  std::ostringstream out;
  out << "| path | shape | dims | contents | when |\n| --- | --- | --- | --- | --- |\n";
  for (const auto& row : layout.rows) {
    const bool is_attribute = row.path.find('@') != std::string_view::npos;
    const std::string shape = row.shape.empty() ? "" : replace_all(std::string(row.shape), ", ", "×");
    const std::string kind = row.kind == ArrayKind::Text      ? "text"
                             : row.kind == ArrayKind::Integer ? "integer"
                             : row.kind == ArrayKind::Single  ? "32-bit real"
                                                              : "";
    const std::string dims = is_attribute || row.dims == "1" ? "" : std::string(row.dims);
    const std::string since = row.since.empty() ? "" : "from " + std::string(row.since) + " on";
    const auto format = [](const std::string& text) {
      return replace_all(replace_all(replace_all(text, "{", ""), "}", ""), "|", "\\|");
    };
    // A note after "= " is in place of the description.
    const bool replaces = row.note.starts_with("= ");
    const std::string about =
        replaces ? std::string(row.note.substr(2)) : join({std::string(row.description), std::string(row.note)}, "; ");
    out << "| `" << format_path(row.path) << "` | " << join({shape, kind}, " ") << " | " << format(dims) << " | "
        << format(about) << " | " << join({std::string(row.when), since}, "; ") << " |\n";
  }
  return out.str();
}

/// The page with the table of the layout between its two marks.
std::string put_table(const std::string& page, const Layout& layout) {
  const std::string begin = "<!-- layout of " + std::string(layout.format) + " -->\n", end = "<!-- end of layout -->\n";
  const auto from = page.find(begin);
  const auto to = from == std::string::npos ? from : page.find(end, from);
  if (to == std::string::npos) return {};
  return page.substr(0, from + begin.size()) + make_table(layout) + page.substr(to);
}

TEST(Layouts, EveryWrittenArrayHasItsRow) {
  const TempFolder folder;
  write_modes(test::make_random_modes(11, 5, 4), folder.at("modes.h5"));
  for (const FileInfo& info : {write_and_list_body(), read_info(folder.at("modes.h5"))}) {
    const Layout* layout = find_layout(info.attributes.at("format"));
    ASSERT_NE(layout, nullptr);
    EXPECT_THAT(find_layout_faults(info), IsEmpty());
    for (const auto& [name, value] : info.attributes) EXPECT_TRUE(find_row(*layout, "/@" + name)) << name;
    for (const auto& object : info.objects) {
      const auto match = find_row(*layout, object.path);
      ASSERT_TRUE(match) << object.path;
      if (object.type == "attribute") continue;
      EXPECT_EQ(object.description, match->fill_in(match->row->description)) << object.path;
    }
  }
}

TEST(Layouts, MissingAndMisshapenArraysAreNamed) {
  const FileInfo whole = write_and_list_body();
  EXPECT_THAT(find_layout_faults(remove(whole, "/modal/mass")), ElementsAre("/modal/mass is missing, expected 4 x 4"));
  EXPECT_THAT(find_layout_faults(change(whole, "/modal/stiffness", &ObjectInfo::shape, "4 x 5")),
              ElementsAre("/modal/stiffness has the shape 4 x 5, expected 4 x 4"));
  EXPECT_THAT(find_layout_faults(change(whole, "/nodes/id", &ObjectInfo::type, "float64")),
              ElementsAre("/nodes/id is of type float64, expected int32"));
  EXPECT_THAT(find_layout_faults(change(whole, "/integrals/exact/gamma2", &ObjectInfo::shape, "4 x 3 x 3")),
              ElementsAre("/integrals/exact/gamma2 has the shape 4 x 3 x 3, expected 4 x 4 x 3"));
  EXPECT_THAT(find_layout_faults(change(whole, "/mesh/elements/quad4/id", &ObjectInfo::shape, "9")),
              ElementsAre("/mesh/elements/quad4/id has the shape 9, expected 2"));
  EXPECT_THAT(find_layout_faults(remove(whole, "/preload/inertial")), IsEmpty()) << "not in every file";
}

TEST(Layouts, PathsMatchByPlaceholders) {
  const Layout layout{"", "", {{"/a/{name}/b_{k}"}, {"/a/{name}/b"}, {"/g@{name}"}, {"/a/x/b_all"}}};
  const auto find = [&](const char* path) {
    const auto match = find_row(layout, path);
    return match ? std::string(match->row->path) + " " + match->word : "none";
  };
  EXPECT_EQ(find("/a/x/b_3"), "/a/{name}/b_{k} 3");
  EXPECT_EQ(find("/a/x/b_all"), "/a/x/b_all ");
  EXPECT_EQ(find("/a/x/b"), "/a/{name}/b x");
  EXPECT_EQ(find("/g@word"), "/g@{name} word");
  EXPECT_EQ(find("/a/x/y/b"), "none");
  EXPECT_EQ(find("/a//b"), "none");
  const auto match = find_row(*find_layout("bough-flexbody"), "/third_order/energy_small");
  EXPECT_EQ(match->row->path, "/third_order/energy_small");
}

TEST(Layouts, CommasInParenthesesDoNotSplitAShape) {
  EXPECT_THAT(split_shape("p, C(N+k-1, k), 6"), ElementsAre("p", "C(N+k-1, k)", "6"));
  EXPECT_THAT(split_shape("n"), ElementsAre("n"));
  EXPECT_THAT(split_shape(""), IsEmpty());
}

TEST(Layouts, CountsOfGroupsAreNotThoseOfTheFile) {
  for (const auto& layout : get_layouts())
    for (const auto& row : layout.rows)
      if (layout.format != "bough-sweep" && row.path.find('{') == std::string_view::npos)
        for (const auto& size : split_shape(row.shape))
          EXPECT_TRUE(size != "e" && size != "k") << layout.format << " " << row.path << ": counts of /mesh/elements";
}

TEST(Layouts, RowsAreUniqueAndDescribed) {
  for (const auto& layout : get_layouts()) {
    std::set<std::string_view> paths;
    for (const auto& row : layout.rows) {
      EXPECT_TRUE(paths.insert(row.path).second) << layout.format << " " << row.path;
      const bool is_attribute = row.path.find('@') != std::string_view::npos;
      EXPECT_EQ(row.description.empty(), is_attribute) << layout.format << " " << row.path;
      EXPECT_FALSE(is_attribute && row.note.empty()) << layout.format << " " << row.path;
    }
  }
}

TEST(Layouts, ManualHasTheTableOfEachLayout) {
  for (const auto& layout : get_layouts()) {
    if (layout.page.empty()) continue;
    const std::string path = std::string(BOUGH_SOURCE_DIR) + "/docs/formats/" + std::string(layout.page) + ".md";
    std::ostringstream found;
    found << std::ifstream(path).rdbuf();
    const std::string expected = put_table(found.str(), layout);
    ASSERT_FALSE(expected.empty()) << path << " has no marks of the layout of " << layout.format;
    if (std::getenv("BOUGH_WRITE_PAGES") != nullptr)
      std::ofstream(path) << expected;
    else
      EXPECT_TRUE(found.str() == expected)
          << path << " is stale; BOUGH_WRITE_PAGES=1 ctest -R hdf5.Layouts writes its table";
  }
}

}  // namespace
}  // namespace bough::hdf5
