#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "lodestar/wms/mqtt_link.hpp"
#include "lodestar/wms/site_client.hpp"
#include "support/bridge_params.hpp"
#include "support/real_time.hpp"

namespace lodestar::test {

const BackOff kQuick{from_seconds(0.05), from_seconds(0.2)};

/// A site that remembers what it was handed.
struct Site {
  explicit Site(std::vector<std::string> brokers)
      : client(link_to_each(mqtt("site", std::move(brokers))), kQuick, "+", "+",
               [this](const std::string&, const std::string& document) {
                 documents.push_back(document);
                 if (kept) kept();
               }) {}

  void poll() { client.poll(clocks().monotonic); }
  void expect_all_once(std::uint64_t count) const {
    ASSERT_EQ(documents.size(), count);
    for (std::uint64_t n = 1; n <= count; ++n) ASSERT_EQ(document_key_from(documents[n - 1])->sequence, n);
  }

  std::vector<std::string> documents;
  std::function<void()> kept;  ///< called with each document, before it is acknowledged
  SiteClient client;
};

}  // namespace lodestar::test
