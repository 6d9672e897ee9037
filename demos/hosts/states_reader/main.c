// Prints what `tandem peer --publish dds:DOMAIN` shows, as rows. Usage: states_reader DOMAIN
#include <stdio.h>
#include <stdlib.h>

#include <dds/dds.h>

#include "states.h"

static dds_entity_t makeReader(dds_entity_t member, const dds_topic_descriptor_t* type,
                               const char* name) {
  // Without more words: best effort, and the newest sample of each instance.
  return dds_create_reader(member, dds_create_topic(member, type, name, NULL, NULL), NULL, NULL);
}

static void printHand(const tandem_dds_HandState* hand) {
  const tandem_dds_Vector *p = &hand->position, *f = &hand->force;
  printf("hand,%u,%llu,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", hand->site,
         (unsigned long long)hand->tick, hand->time, p->x, p->y, p->z, f->x, f->y, f->z);
}

static void printObject(const tandem_dds_ObjectState* object) {
  const tandem_dds_Vector* p = &object->position;
  const tandem_dds_Quaternion* q = &object->orientation;
  printf("object %u,%u,%llu,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", object->object,
         object->site, (unsigned long long)object->tick, object->time, p->x, p->y, p->z, q->w, q->x,
         q->y, q->z);
}

int main(int count, char** words) {
  const unsigned domain = count > 1 ? (unsigned)atoi(words[1]) : 0;
  const dds_entity_t member = dds_create_participant(domain, NULL, NULL);
  const dds_entity_t hands = makeReader(member, &tandem_dds_HandState_desc, "tandem/hands");
  const dds_entity_t objects = makeReader(member, &tandem_dds_ObjectState_desc, "tandem/objects");
  if (hands < 0 || objects < 0) return 1;
  for (;; dds_sleepfor(DDS_MSECS(5))) {
    void* sample = NULL;  // lent by Cyclone
    dds_sample_info_t info;
    while (dds_take(hands, &sample, &info, 1, 1) > 0) {
      if (info.valid_data) printHand(sample);
      dds_return_loan(hands, &sample, 1);
    }
    while (dds_take(objects, &sample, &info, 1, 1) > 0) {
      if (info.valid_data) printObject(sample);
      dds_return_loan(objects, &sample, 1);
    }
    fflush(stdout);
  }
}
