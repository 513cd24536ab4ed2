/* Calls the plugin, which is in Fortran and uses the library. */
void force(void);

int main(void)
{
    force();
    return 0;
}
