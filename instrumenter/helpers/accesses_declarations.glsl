// Where lookups read; the layout of sd_words is described in accesses.h.
layout(std430) buffer sd_Accesses { SD_HIGHP int sd_words[]; };
bool sd_on;  // this thread is one of those that count
