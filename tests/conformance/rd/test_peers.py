"""The other codecs, on a short generated sequence, as far as they are built."""
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "..", "conformance", "rd"))

import configurations  # noqa: E402
import rate_distortion  # noqa: E402
import sequences  # noqa: E402

BUILD = os.environ.get("REEB_BUILD", "")


@unittest.skipUnless(BUILD, "REEB_BUILD does not name a build folder")
class PeerTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.programs = rate_distortion.Programs(BUILD)
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.sequence, = sequences.samples(cls.programs.paths["reeb"], ["mechanism:3"], cls.folder.name)

    def measure(self, name, setting):
        configuration, = configurations.select([name])
        if self.programs.lacking(configuration):
            self.skipTest(f"{name} is not built")
        return rate_distortion.measure(rate_distortion.Job(self.sequence, configuration, setting, self.programs, ""))

    def test_fine_quantization_is_close(self):
        for name, bits in (("draco", "14"), ("meshopt", "14")):
            with self.subTest(name):
                self.assertLess(self.measure(name, bits)["kg"], 0.02)  # a step is 1/16383 of the longest side

    def test_zfp_keeps_its_bound(self):
        coarse, fine = self.measure("zfp", "0.01"), self.measure("zfp", "0.0001")
        self.assertLess(fine["max_error"], coarse["max_error"])
        self.assertLess(fine["kg"], 0.05)
        self.assertLess(coarse["bytes"], fine["bytes"])

    def test_lossless_loses_nothing(self):
        for name in ("fpzip-lossless", "zfp-lossless"):
            with self.subTest(name):
                row = self.measure(name, "0")
                self.assertEqual((row["kg"], row["max_error"], row["sted"]), (0, 0, 0))

    def test_pca_meets_its_target(self):
        for target in ("1", "0.1"):
            kg = self.measure("pca", target)["kg"]
            self.assertLessEqual(kg, float(target) * 1.0001)
            self.assertGreater(kg, float(target) * 0.98)


if __name__ == "__main__":
    unittest.main()
