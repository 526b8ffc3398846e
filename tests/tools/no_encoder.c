// Put before a program by LD_PRELOAD, libavcodec has no encoder of any name, as on a machine where it was built so.
struct AVCodec;

const struct AVCodec* avcodec_find_encoder_by_name(const char* name) {
  (void)name;
  return 0;
}
