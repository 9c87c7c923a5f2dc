#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "lodestar/base/common/drop_counts.hpp"
#include "lodestar/wms/clock.hpp"
#include "lodestar/wms/site_messages.hpp"

namespace lodestar {

struct OutboxParams {
  std::uint64_t window = 50;                   ///< documents on their way at most
  Duration resend_after = from_seconds(5);     ///< without a word from the site; doubles each time
  Duration resend_at_most = from_seconds(60);  ///< ... up to this
};

/// Why an acknowledgement moves nothing.
enum class AckDrop {
  kMalformed,    ///< not what the integrator's page asks for
  kOtherStream,  ///< of another store, such as one that was set aside
  kRepeated,     ///< the number that was acknowledged last
  kLate,         ///< a smaller one
  kAhead,        ///< a number that was never sent
  kCount
};
const char* name(AckDrop reason);

/// How far one stream is, each number at most as large as the next.
struct StreamProgress {
  std::uint64_t acknowledged = 0;  ///< by the site
  std::uint64_t sent = 0;          ///< ever, also by a bridge before this one
  std::uint64_t recorded = 0;
};

/// Documents from `first` on, `count` of them.
struct Batch {
  std::uint64_t first = 0, count = 0;
};

/// What may be sent, and what is done: a sliding window over the numbers of one stream, which only the site's
/// cumulative acknowledgement moves (go-back-N). The broker's word that it took a message means nothing here: it may be
/// killed right after. Whatever is on its way when the connection breaks, or the site is silent, is sent again from the
/// first number that is not acknowledged; the site drops what it knows. Holds no document and reads no clock.
class Outbox {
 public:
  Outbox(const OutboxParams& params, std::string stream, const StreamProgress& start);

  void recorded(std::uint64_t last) { last_ = last; }
  void connected(Instant now);
  void disconnected() { connected_ = false; }

  /// What to send now.
  Batch due(Instant now);
  void sent(const Batch& batch, Instant now);

  /// @param retained an old word of the site that the broker kept, not an answer to what was just sent
  /// @return whether acknowledged() moved
  bool take(const std::string& message, bool retained, Instant now);

  std::uint64_t acknowledged() const { return acknowledged_; }
  std::uint64_t waiting() const { return last_ - acknowledged_; }  ///< not acknowledged
  std::uint64_t on_their_way() const { return next_ - 1 - acknowledged_; }
  std::uint64_t resends() const { return resends_; }
  /// Since when the site has not moved anything of what was sent, over which connections ever; empty: nothing was sent.
  std::optional<Instant> unanswered_since() const { return unanswered_since_; }
  /// The site's last word, where it has less than it said before, as one that was restored from a backup.
  std::optional<std::uint64_t> site_fell_back() const { return site_fell_back_; }
  const DropCounts<AckDrop>& drops() const { return drops_; }

 private:
  void complain(std::uint64_t sequence, Instant now);
  void go_back(Instant now);
  bool drop(AckDrop reason);

  OutboxParams params_;
  std::string stream_;
  std::uint64_t acknowledged_, sent_, last_;
  std::uint64_t next_;  ///< to be sent
  bool connected_ = false;
  Instant progress_;  ///< when something last moved
  std::optional<Instant> unanswered_since_;
  std::optional<std::uint64_t> site_fell_back_;
  Duration patience_;
  std::uint64_t resends_ = 0;
  DropCounts<AckDrop> drops_;
};

}  // namespace lodestar
