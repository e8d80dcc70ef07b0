#pragma once
/// \file The HTTP server of the studio: loopback only, one token, one origin. It reads no file of the user: requests
/// are answered by child processes that are confined to the folder.
#include <memory>
#include <string>
#include <vector>

#include "base/non_copyable.hpp"

namespace bough::cli {

struct ServerOptions {
  std::string folder;              ///< real path of the folder of the studio
  std::vector<std::string> files;  ///< opened at first, relative to the folder
  int port = 0;                    ///< 0: a free one
};

class StudioServer : private NonCopyable {
 public:
  /// Binds 127.0.0.1. \throws InputError "studio.no-port".
  explicit StudioServer(ServerOptions options);
  ~StudioServer();

  /// http://127.0.0.1:PORT/TOKEN/
  std::string get_address() const;
  /// Serves in another thread until stop() or a request for the end of the studio.
  void start();
  /// Returns true until stop() or a request for the end.
  bool is_running() const;
  /// Ends the thread and all jobs.
  void stop();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace bough::cli
