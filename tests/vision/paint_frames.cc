// paint_frames WIDTH HEIGHT RATE_HZ [JITTER_MS [DROP_SHARE]]
//
// A camera for tests: grey pictures on standard output (NUT, uncompressed), in real time. Picture n
// is taken at n / RATE on the computer's clock, whoever paints it, as by cameras with a common
// trigger, and carries the number n. It is sent up to JITTER late; a share of them is left out, as
// is what nobody took in time.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <random>
#include <thread>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include "support/bar_code.h"

namespace {

using Clock = std::chrono::system_clock;

cv::Mat Ground(cv::Size size) {
  cv::Mat picture(size, CV_8UC1);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      picture.at<uchar>(y, x) = static_cast<uchar>(128 + 60 * std::sin(0.021 * x + 0.013 * y) +
                                                   30 * std::sin(0.17 * x - 0.11 * y));
    }
  }
  return picture;
}

// The pictures with the times at which they were taken, as FFmpeg reads them.
class Output {
 public:
  Output(cv::Size size, double rate) {
    av_log_set_level(AV_LOG_QUIET);
    avformat_alloc_output_context2(&container_, nullptr, "nut", "pipe:1");
    AVStream* stream = avformat_new_stream(container_, nullptr);
    stream->codecpar->codec_type = AVMEDIA_TYPE_VIDEO;
    stream->codecpar->codec_id = AV_CODEC_ID_RAWVIDEO;
    stream->codecpar->format = AV_PIX_FMT_GRAY8;
    stream->codecpar->codec_tag = MKTAG('Y', '8', '0', '0');
    stream->codecpar->width = size.width;
    stream->codecpar->height = size.height;
    stream->time_base = av_inv_q(av_d2q(rate, 100000));
    stream->avg_frame_rate = av_d2q(rate, 100000);
    unit_ = stream->time_base;
    container_->flags |= AVFMT_FLAG_FLUSH_PACKETS;
    good_ = avio_open(&container_->pb, "pipe:1", AVIO_FLAG_WRITE) >= 0 &&
            avformat_write_header(container_, nullptr) >= 0;
  }

  bool Write(const cv::Mat& picture, int64_t n) {
    if (first_ < 0) first_ = n;
    AVPacket* packet = av_packet_alloc();
    av_new_packet(packet, static_cast<int>(picture.total()));
    std::copy_n(picture.data, picture.total(), packet->data);
    packet->pts = packet->dts = av_rescale_q(n - first_, unit_, container_->streams[0]->time_base);
    packet->flags |= AV_PKT_FLAG_KEY;
    good_ = good_ && av_write_frame(container_, packet) >= 0;
    av_packet_free(&packet);
    return good_;
  }

 private:
  AVFormatContext* container_ = nullptr;
  AVRational unit_{};  // what is asked of the container
  int64_t first_ = -1;
  bool good_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  const cv::Size size(std::atoi(argv[1]), std::atoi(argv[2]));
  const double rate = std::atof(argv[3]);
  const double jitter_ms = argc > 4 ? std::atof(argv[4]) : 0;
  const double drop_share = argc > 5 ? std::atof(argv[5]) : 0;
  std::mt19937 random(static_cast<unsigned>(getpid()));
  std::uniform_real_distribution<double> uniform(0, 1);
  cv::Mat picture = Ground(size);
  const auto now_s = [] {
    return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
  };
  Output output(size, rate);
  int64_t n = 0;
  while (true) {
    n = std::max(n + 1, static_cast<int64_t>(std::floor(now_s() * rate)) + 1);
    std::this_thread::sleep_for(
        std::chrono::duration<double>(static_cast<double>(n) / rate - now_s()));
    if (uniform(random) < drop_share) continue;
    softforce::testing::PaintNumber(static_cast<uint32_t>(n & 0xFFFFFF), &picture);
    std::this_thread::sleep_for(std::chrono::duration<double>(1e-3 * jitter_ms * uniform(random)));
    if (!output.Write(picture, n)) return 0;
  }
}
