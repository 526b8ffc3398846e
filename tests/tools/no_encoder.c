// Loaded with LD_PRELOAD, this makes libavcodec find no encoder by name, as on a machine whose build has none.
struct AVCodec;

const struct AVCodec* avcodec_find_encoder_by_name(const char* name) {
  (void)name;
  return 0;
}
