#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <thread>

#include "serve/raw_client.h"
#include "softforce/serve/live_page.h"

namespace softforce::serve {
namespace {

using testing::Ask;
using ::testing::HasSubstr;
using testing::RawClient;
using ::testing::StartsWith;

constexpr char kToken[] = "0123456789abcdef0123456789abcdef";

LivePageOptions Options() {
  LivePageOptions options;
  options.token = kToken;
  options.longest_request = std::chrono::milliseconds(300);
  options.longest_write = std::chrono::milliseconds(300);
  return options;
}

// A page that is sent what it should not be, and must serve all the same afterwards.
class MalformedRequests : public ::testing::Test {
 protected:
  ~MalformedRequests() override {
    // While all connections are taken more are closed; they are free when their time is over.
    std::string answer;
    for (int i = 0; i < 2000 && answer.empty(); ++i) {
      answer = Ask(page_.port(), Line("GET / HTTP/1.1") + "\r\n");
      std::this_thread::sleep_for(std::chrono::milliseconds(i == 0 ? 0 : 10));
    }
    EXPECT_THAT(answer, HasSubstr("still here"));
    EXPECT_EQ(controlled_, 0);
  }

  std::string Line(const std::string& first) const {
    return fmt::format("{}\r\nHost: localhost:{}\r\n", first, page_.port());
  }

  Broadcast broadcast_;
  std::atomic<int> controlled_{0};
  LivePage page_{Options(),
                 {{"/", {"text/html", "still here"}}},
                 {{"tare", [this] { ++controlled_; }}, {"stop", [this] { ++controlled_; }}},
                 &broadcast_};
};

TEST_F(MalformedRequests, OfMixedUpPiecesAreHarmless) {
  const std::vector<std::string> pieces{"GET ",
                                        "POST ",
                                        "PUT ",
                                        "/",
                                        "/tare",
                                        "/pictures/99999999999",
                                        "/%00%ff",
                                        "/../",
                                        "*",
                                        " HTTP/1.1",
                                        "\r\n",
                                        "\n",
                                        "Host: localhost:1",
                                        ":",
                                        "\r\n\r\n",
                                        "Range: bytes=0-18446744073709551615",
                                        "Range: bytes=-1,5-2,,",
                                        "Content-Length: -5",
                                        "Content-Length: 99999999999999999999",
                                        "Transfer-Encoding: chunked",
                                        "ffffffffffffffff\r\n",
                                        "Expect: 100-continue",
                                        "Content-Type: multipart/form-data; boundary=",
                                        "Content-Encoding: gzip",
                                        std::string("\0\x01\xff\xfe", 4),
                                        std::string(300, 'A'),
                                        fmt::format("Host: localhost:{}", page_.port())};
  std::mt19937 random(1);
  for (int i = 0; i < 400; ++i) {
    RawClient client(page_.port());
    ASSERT_TRUE(client.connected());
    const int count = std::uniform_int_distribution<>(1, 20)(random);
    std::string request;
    for (int k = 0; k < count; ++k) {
      request += pieces[std::uniform_int_distribution<size_t>(0, pieces.size() - 1)(random)];
    }
    client.Send(request);
    if (i % 2 == 0) client.Reset();
  }
}

TEST_F(MalformedRequests, OfRandomBytesAreHarmless) {
  std::mt19937 random(2);
  for (int i = 0; i < 200; ++i) {
    std::string bytes(std::uniform_int_distribution<size_t>(1, 3000)(random), ' ');
    for (char& byte : bytes) {
      byte = static_cast<char>(std::uniform_int_distribution<>(0, 255)(random));
    }
    RawClient client(page_.port());
    client.Send(bytes);
    client.EndSending();
  }
}

TEST_F(MalformedRequests, ThatAreValidButForOneByteAreHarmless) {
  const std::string valid =
      Line("POST /tare HTTP/1.1") + "X-Softforce-Token: 0\r\nContent-Length: 3\r\n\r\nabc";
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    std::string request = valid;
    request[std::uniform_int_distribution<size_t>(0, valid.size() - 1)(random)] =
        static_cast<char>(std::uniform_int_distribution<>(0, 255)(random));
    RawClient client(page_.port());
    client.Send(request.substr(0, std::uniform_int_distribution<size_t>(1, valid.size())(random)));
    if (i % 3 == 0) client.Reset();
  }
}

TEST_F(MalformedRequests, WithEndlessHeadersAreCutOff) {
  RawClient client(page_.port());
  client.Send(Line("GET / HTTP/1.1"));
  bool open = true;
  // 100 MB, unless the other side closes.
  for (int i = 0; i < 100'000 && open; ++i) {
    open = client.Send(fmt::format("X-{}: {}\r\n", i, std::string(1000, 'x')));
  }
  EXPECT_FALSE(open);
}

TEST_F(MalformedRequests, WithAHugeLineAreCutOff) {
  RawClient client(page_.port());
  client.Send("GET /");
  bool open = true;
  for (int i = 0; i < 100'000 && open; ++i) open = client.Send(std::string(1000, 'x'));
  EXPECT_FALSE(open);
}

TEST_F(MalformedRequests, ThatTrickleInAreCutOff) {
  RawClient client(page_.port());
  bool open = true;
  // A byte now and then would keep a connection for hours if only silence counted.
  for (int i = 0; i < 2000 && open; ++i) {
    open = client.Send("a");
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_FALSE(open);
}

TEST_F(MalformedRequests, OfReadersWhoNeverReadDoNotHoldTheWriterUp) {
  RawClient reader(page_.port());
  reader.Send(Line("GET /events HTTP/1.1") + "\r\n");
  reader.Receive("\r\n\r\n");
  const std::string large(1'000'000, ' ');

  // Far more than the system keeps for a connection; publishing returns all the same.
  uint64_t published = 0;
  while (broadcast_.readers() > 0 && published < 5000) {
    broadcast_.Publish(std::make_shared<PageState>(PageState{large, {}, {}}));
    ++published;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }

  EXPECT_EQ(broadcast_.readers(), 0) << "the connection is given up";
  EXPECT_EQ(broadcast_.Read().number, published);
}

TEST_F(MalformedRequests, OfManyAtOnceAreHarmless) {
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int i = 0; i < 200; ++i) {
    clients.push_back(std::make_unique<RawClient>(page_.port()));
    clients.back()->Send("GET / HT");
  }
  clients.clear();
}

}  // namespace
}  // namespace softforce::serve
