// Its library has drawn before this main begins (static_constructor.cpp).
extern "C" bool pixelsWereRight();

int main() {
  return pixelsWereRight() ? 0 : 1;
}
