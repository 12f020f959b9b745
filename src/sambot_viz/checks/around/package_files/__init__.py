"""Rules about package.xml, CMakeLists.txt, setup.py and setup.cfg."""
