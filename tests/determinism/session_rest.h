// session_rest.h - what a user of a random session (session.h) may do besides: heat and engines, settings of joints and of the
// world, values beyond the usual.
#ifndef SESSION_REST_H
#define SESSION_REST_H

#include "session.h"

// Some calls, from none to many; follows from the seed alone, as session_act.
void session_act_besides(session *s);

#endif
