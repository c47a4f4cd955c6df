#include "vision/segment_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <string>

extern "C" {
#include <libavutil/opt.h>
}

#include "softforce/base/input_error.h"
#include "vision/libav.h"

namespace softforce::vision {

struct SegmentWriter::State {
  std::filesystem::path file;
  AvOwned<AVFormatContext> container;
  AvOwned<AVCodecContext> codec;
  AvOwned<AVFrame> frame{av_frame_alloc()};
  AvOwned<AVPacket> packet{av_packet_alloc()};
  AVStream* stream = nullptr;  // the container's
  int64_t last_ms = -1;

  ~State() {
    if (container != nullptr && container->pb != nullptr) avio_closep(&container->pb);
  }

  void Require(bool holds, const char* problem) const {
    if (holds) return;
    throw base::InputError(file.string(), std::string("cannot be recorded: ") + problem,
                           "Check the folder's permissions and the disk's space.");
  }

  void OpenCodec(cv::Size size) {
    const AVCodec* encoder = avcodec_find_encoder(AV_CODEC_ID_MAGICYUV);
    Require(encoder != nullptr, "FFmpeg has no MagicYUV encoder");
    codec.reset(avcodec_alloc_context3(encoder));
    codec->width = size.width;
    codec->height = size.height;
    codec->pix_fmt = AV_PIX_FMT_GRAY8;
    codec->color_range = AVCOL_RANGE_JPEG;
    codec->time_base = {1, 1000};
    codec->thread_count = 1;
    codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    av_opt_set(codec->priv_data, "pred", "left", 0);  // as small as the others, and the fastest
    Require(avcodec_open2(codec.get(), encoder, nullptr) >= 0, "the encoder does not open");
  }

  void Open(cv::Size size) {
    av_log_set_level(AV_LOG_FATAL);  // what goes wrong is reported here
    AVFormatContext* made = nullptr;
    avformat_alloc_output_context2(&made, nullptr, "matroska", file.c_str());
    Require(made != nullptr, "FFmpeg cannot write Matroska");
    container.reset(made);
    OpenCodec(size);
    stream = avformat_new_stream(made, nullptr);
    Require(stream != nullptr, "out of memory");
    stream->time_base = codec->time_base;
    avcodec_parameters_from_context(stream->codecpar, codec.get());
    Require(avio_open(&made->pb, file.c_str(), AVIO_FLAG_WRITE) >= 0, "the file cannot be opened");
    Require(avformat_write_header(made, nullptr) >= 0, "its header cannot be written");
    frame->format = codec->pix_fmt;
    frame->width = size.width;
    frame->height = size.height;
    Require(av_frame_get_buffer(frame.get(), 0) >= 0, "out of memory");
  }

  int64_t Store() {
    int64_t bytes = 0;
    while (avcodec_receive_packet(codec.get(), packet.get()) >= 0) {
      bytes += packet->size;
      packet->stream_index = stream->index;
      av_packet_rescale_ts(packet.get(), codec->time_base, stream->time_base);
      Require(av_write_frame(container.get(), packet.get()) >= 0, "a picture cannot be stored");
      av_packet_unref(packet.get());
      // Closes Matroska's cluster, which it otherwise holds in memory for up to five seconds.
      Require(av_write_frame(container.get(), nullptr) >= 0, "a picture cannot be stored");
      avio_flush(container->pb);
      Require(container->pb->error >= 0, "a picture cannot be stored");
    }
    return bytes;
  }
};

SegmentWriter::SegmentWriter(const std::filesystem::path& file, cv::Size size) : state_(new State) {
  state_->file = file;
  state_->Open(size);
}
SegmentWriter::~SegmentWriter() = default;

int64_t SegmentWriter::Add(const cv::Mat& picture, double time_s) {
  State& s = *state_;
  s.Require(picture.type() == CV_8UC1 && picture.cols == s.codec->width &&
                picture.rows == s.codec->height,
            "the size of the camera's pictures changed");
  s.Require(av_frame_make_writable(s.frame.get()) >= 0, "out of memory");
  picture.copyTo(cv::Mat(picture.size(), CV_8UC1, s.frame->data[0],
                         static_cast<size_t>(s.frame->linesize[0])));
  s.last_ms = std::max(s.last_ms + 1, static_cast<int64_t>(std::llround(1e3 * time_s)));
  s.frame->pts = s.last_ms;
  s.Require(avcodec_send_frame(s.codec.get(), s.frame.get()) >= 0, "the encoder refuses a picture");
  return s.Store();
}

void SegmentWriter::Finish() {
  State& s = *state_;
  avcodec_send_frame(s.codec.get(), nullptr);
  s.Store();
  s.Require(av_write_trailer(s.container.get()) >= 0, "its index cannot be stored");
  s.Require(avio_closep(&s.container->pb) >= 0, "it cannot be closed");
}

void SyncToDisk(const std::filesystem::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return;
  fsync(file);  // where the disk fails, the next write says so
  close(file);
}

}  // namespace softforce::vision
