/* Two users push one cube, as in README.md, from C: each has a world of Tandem's. */

#include <stdio.h>
#include <stdlib.h>

#include "tandem/tandem.h"

/* docs/c.md: the code block there is what stands from here to the next such line. */
static void check(TandemResult result) {
  if (result == TANDEM_OK) return;
  fprintf(stderr, "%s: %s\n", tandem_result_name(result), tandem_last_error());
  exit(1);
}

int main(void) {
  TandemWorld* worlds[2]; /* two users' programs; each with a cube of 4 cm and 200 g */
  TandemDevice* devices[2];
  TandemLink* links[2];
  TandemSite* sites[2];
  TandemBody cubes[2];
  const double starts[2][3] = {{-0.03, 0, 0}, {0.03, 0, 0}}, push[3] = {5, 0, 0}; /* [m], [N] */
  const TandemNetwork network = {.delay = 0.05};
  check(tandem_link_create_simulated(&network, &links[0], &links[1]));

  for (unsigned i = 0; i < 2; ++i) {
    TandemBodySettings cube = tandem_default_body_settings();
    TandemSiteSettings settings = tandem_default_site_settings();
    settings.self = i + 1;
    settings.has_guide = 1; /* a slot along x; without it bodies move and turn freely */
    check(tandem_world_create(&worlds[i]));
    check(tandem_world_add_body(worlds[i], &cube, &cubes[i]));
    check(tandem_device_create_simulated(0.1, 0.5, starts[i], settings.guide, &devices[i]));
    check(tandem_site_create(&settings, worlds[i], devices[i], &sites[i]));
    check(tandem_site_share(sites[i], cubes[i], 0, NULL));
    check(tandem_site_connect(sites[i], 2 - i, links[i], starts[1 - i], NULL));
  }
  check(tandem_device_set_hand(devices[0], push));

  for (int step = 0; step < 60; ++step) /* one second; each step runs its 1 kHz ticks */
    for (unsigned i = 0; i < 2; ++i) check(tandem_world_step(worlds[i], 1.0 / 60, 0, 0));

  TandemState cube[2];
  TandemReading reading;
  for (unsigned i = 0; i < 2; ++i)
    check(tandem_world_get_states(worlds[i], 1, &cubes[i], &cube[i]));
  check(tandem_site_read(sites[0], &reading, 0, NULL, 0, NULL, NULL));
  printf("cube at %.4f m here, %.4f m there; force on user 1: %.3f N\n", cube[0].position[0],
         cube[1].position[0], reading.force[0]);

  for (unsigned i = 0; i < 2; ++i) { /* sites go first */
    check(tandem_site_destroy(sites[i]));
    check(tandem_world_destroy(worlds[i]));
    check(tandem_device_destroy(devices[i]));
    check(tandem_link_destroy(links[i]));
  }
  return 0;
}
/* docs/c.md */
