/* Takes the errors of a calibrated IMU out of its readings, and checks this on the readings that
   come with the calibration. By hand:

       cc -std=c99 -DCALIBRATION='"reports/demo.calibration.h"' -I. docs/apply/apply.c -lm -o apply
       ./apply
*/
#include <stdio.h>
#include CALIBRATION

enum { ROUNDS = 20 }; /* three are enough where effects are small */
static const double ALLOWED = 1e-9; /* of the length of the vector */

/* truth = inverse (reading - bias - effects(truth)), inserted into itself. `truth` is one of `f` and
   `w`: specific force, m/s^2, of the accelerometers; angular rate, rad/s, of the gyros. */
static void correct(const struct triad *triad, const double reading[3], const double f[3],
                    const double w[3], double t, double T, double truth[3])
{
    double sensed[3], added[3] = {0, 0, 0};
    for (int round = 0; round < ROUNDS; round++) {
        for (int i = 0; i < 3; i++)
            sensed[i] = reading[i] - triad->bias[i] - added[i];
        for (int i = 0; i < 3; i++) {
            truth[i] = added[i] = 0;
            for (int j = 0; j < 3; j++)
                truth[i] += triad->inverse[i][j] * sensed[j];
        }
        triad->effects(f, w, sensed, t, T, added);
    }
}

/* Specific force and angular rate from one reading of all six sensors; the accelerometers come
   first, because what gyros read may depend on the specific force. */
static void correct_both(const struct mount *mount, const struct sample *in, double force[3],
                         double rate[3])
{
    rate[0] = rate[1] = rate[2] = 0;
    correct(&mount->accelerometer, in->f_reading, force, rate, in->t, in->T, force);
    correct(&mount->gyroscope, in->w_reading, force, rate, in->t, in->T, rate);
}

/* 1 where `truth` is not what it ought to be; nothing is compared where that is not known. */
static int differs(const char *name, const double truth[3], const double expected[3])
{
    double difference = 0, length = 0;
    if (isnan(expected[0]))
        return 0;
    for (int i = 0; i < 3; i++) {
        difference = hypot(difference, truth[i] - expected[i]);
        length = hypot(length, expected[i]);
    }
    printf("%s % .17g % .17g % .17g, differs by %.1e\n", name, truth[0], truth[1], truth[2],
           difference);
    return !(difference <= ALLOWED * length);
}

int main(void)
{
    int wrong = 0;
    printf("%s, serial number %s%s\n", instrument, serial, simulated ? ", simulated" : "");
    for (int m = 0; m < MOUNTS; m++) {
        const struct mount *mount = &calibration[m];
        printf("%s, campaign %s, %s\n", mount->name, campaign, date);
        for (int s = 0; s < mount->samples; s++) {
            double force[3], rate[3];
            correct_both(mount, &mount->sample[s], force, rate);
            wrong += differs("force, m/s^2:", force, mount->sample[s].f_corrected);
            wrong += differs("rate, rad/s: ", rate, mount->sample[s].w_corrected);
        }
    }
    return wrong != 0;
}
