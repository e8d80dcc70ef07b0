#pragma once
/// \file A campaign: one job over a grid, a list or a sample of parameters, by worker processes; resumable.
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/campaign/batch_outcome.hpp"
#include "analysis/common/events.hpp"

namespace bough::analysis {

struct CampaignRequest {
  std::string campaign;                ///< campaign file
  std::string output;                  ///< folder of the cases and the table; empty: the campaign's name, here
  std::string shard;                   ///< "i/n": only every n-th case from the i-th on; empty: all
  std::vector<std::string> merged;     ///< folders of shards for merge_campaign(); empty: the campaign's own
  int jobs = 0;                        ///< worker processes; 0: one a core, or one a rank
  double time_limit = 0;               ///< s a case; 0: the campaign's
  bool retry = false;                  ///< do failed cases again
  bool restart = false;                ///< do every case again, also after the campaign has changed
  bool may_leave = false;              ///< the steps may write outside the folder of their case
  const volatile int* stop = nullptr;  ///< turns non-zero when a signal came
};

/// Share of the cases of a call: those with (number - 1) % count == index.
struct Shard {
  int index = 0, count = 1;
  /// Returns true if the case belongs to the shard.
  bool holds(int number) const { return (number - 1) % count == index; }
};
/// Throws InputError "batch.bad-shard".
Shard parse_shard(const std::string& text);

struct CampaignAnswer {
  std::string folder;                                  ///< absolute
  int num_selected = 0, num_before = 0, num_done = 0;  ///< cases of this call, of them done before and now
  std::vector<BatchOutcome> failed;                    ///< by number
  double seconds = 0;
  bool completed = true;  ///< not stopped by a signal
  int num_in_table = 0;   ///< cases of all shards
  std::vector<Statistics> statistics;
  std::string missing;  ///< of merge_campaign(): the cases that no folder has, in words; empty: none
};

class CampaignEvents : public Events {
 public:
  /// Called when the workers start.
  virtual void start() {}
  /// Called after each case; `num_open`: cases that this call was to do.
  virtual void show(const CampaignAnswer& /*so_far*/, std::size_t /*num_open*/) {}
};

/// Absolute path of the folder: that of the request, else the name of the campaign in the working directory.
std::filesystem::path find_campaign_folder(const CampaignRequest& request, const BatchPlan& plan);

/// Does the cases that are not done, then writes the tables. Collective, outside mpirun alone. Workers are calls of
/// `bough batch CAMPAIGN --worker FD`, or of BOUGH_WORKER_LAUNCHER. Warning: batch.smaller-table. Throws InputError
/// "batch.changed-campaign", "batch.foreign-folder", "batch.busy"; ComputationError "batch.no-worker", "cli.write".
CampaignAnswer run_campaign(const CampaignRequest& request, const BatchPlan& plan, CampaignEvents& events);

/// Makes one table of what several folders hold, or of the campaign's own: after shards that had a folder each. Throws
/// InputError "batch.changed-campaign", "batch.missing-shard".
CampaignAnswer merge_campaign(const CampaignRequest& request, const BatchPlan& plan);

}  // namespace bough::analysis
