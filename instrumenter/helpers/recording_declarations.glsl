// The recording of chosen threads; the layout of sd_words is described at RecordingLayout in instrumenter.h.
layout(std430) buffer sd_Record { SD_HIGHP int sd_words[]; };
uniform SD_HIGHP ivec4 sd_pixel;  // x, y, width, height of the recorded pixels, in gl_FragCoord's own convention
bool sd_on;                       // this thread is recorded
SD_HIGHP int sd_invocation;       // its order of start + 1; 0 outside of the recorded pixels
SD_HIGHP int sd_base;             // first word of its part of sd_words
SD_HIGHP int sd_room;             // words in its part
SD_HIGHP int sd_wanted;           // words that it has wanted so far, its header included
SD_HIGHP int sd_at;               // where the values of the current record go
bool sd_record(SD_HIGHP int id, SD_HIGHP int words);
bool sd_end(SD_HIGHP int mark);
