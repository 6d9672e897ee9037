#include <cstdio>

extern "C" void attachSite(char* answer, int room);

int main() {
  char answer[1000] = "";
  attachSite(answer, sizeof answer);
  std::printf("%s\n", answer);
}
