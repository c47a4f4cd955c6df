#pragma once

#include <memory>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace softforce::vision {

// FFmpeg's objects, each freed as it wants to be. A container's file stays open: whoever opened it
// closes it.
struct AvFree {
  void operator()(AVCodecContext* p) const { avcodec_free_context(&p); }
  void operator()(AVFrame* p) const { av_frame_free(&p); }
  void operator()(AVPacket* p) const { av_packet_free(&p); }
  void operator()(AVFormatContext* p) const {
    if (p->iformat != nullptr) {
      avformat_close_input(&p);
    } else {
      avformat_free_context(p);
    }
  }
};

template <class T>
using AvOwned = std::unique_ptr<T, AvFree>;

}  // namespace softforce::vision
