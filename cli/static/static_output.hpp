#pragma once
/// \file Outputs of `static` by subcase: a file, tables or JSON, extremes; a subcase is freed when all have it.
#include <future>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "analysis/static/static.hpp"
#include "fe/model/model.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/records/static_result.hpp"

namespace bough::cli {

struct StaticOutputOptions {
  std::string path;  ///< of the HDF5 file; empty: none
  bool has_text = true, has_json = false, is_full = false;
  bool in_cd = false;  ///< text and JSON: vectors in the displacement axes of their grids
  bool has_extremes = false;
  bool keeps = false;  ///< the subcases stay in get_result()
};

/// Processes subcases while the next ones are solved, on a second thread if there is one and enough work for it.
class StaticOutput final : public analysis::StaticReceiver {
 public:
  explicit StaticOutput(StaticOutputOptions options) : options_(std::move(options)) {}
  ~StaticOutput() override;
  StaticOutput(const StaticOutput&) = delete;
  StaticOutput& operator=(const StaticOutput&) = delete;

  void begin(bool keeps) override { options_.keeps = options_.keeps || keeps; }
  void set_model(const fe::Model& model) override;
  void add(std::vector<records::StaticSubcase> subcases) override;
  /// Returns true if the file could not be written; finish() throws the error.
  bool has_failed() override;
  const std::vector<records::StaticSubcase>& get_kept() override { return get_result().subcases; }
  /// With the subcases where they are kept; without extremes before finish().
  const records::StaticResult& get_result();

  /// The file appears. Throws ComputationError "hdf5.write".
  void finish(const std::vector<std::pair<std::string, std::string>>& source);
  const std::string& get_text() const { return text_; }         ///< after finish()
  const nlohmann::json& get_subcases() const { return json_; }  ///< after finish(); a list
  nlohmann::json get_extremes() const;                          ///< after finish()

 private:
  void wait();
  void write(const std::vector<records::StaticSubcase>& subcases);
  void show(const std::vector<records::StaticSubcase>& subcases);
  records::StaticSubcase turn_to_cd(records::StaticSubcase subcase) const;

  StaticOutputOptions options_;
  records::StaticResult result_;
  std::vector<std::pair<int, Eigen::Matrix3d>> turns_;  ///< first row of three numbers, basic to CD
  std::optional<hdf5::StaticWriter> file_;
  std::vector<records::CaseExtremes> shown_extremes_;  ///< with in_cd other than the file's
  std::string text_;
  nlohmann::json json_ = nlohmann::json::array();
  std::exception_ptr failure_;
  std::future<void> running_;  ///< last: it ends before what it works on
};

}  // namespace bough::cli
